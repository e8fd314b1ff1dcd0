#include "sim/scene/read_fabrics.h"

#include "sim/fabric/fabric.h"
#include "sim/scene/read_list.h"
#include "sim/scene/read_place.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

namespace sim {

namespace {

/// The one key of a piece that says what it is.
std::string kindOf(const Node& node, const std::string& path)
{
    std::string kind;
    for (const std::string& candidate : fabricShapeKinds()) {
        if (!node.find(candidate)) continue;
        if (!kind.empty()) fail(node.location, fmt::format("{}: has both {} and {}; make them two pieces", path, kind, candidate));
        kind = candidate;
    }
    if (kind.empty()) fail(node.location, fmt::format("{}: says no fabric; it takes one of {}", path, listed(fabricShapeKinds())));
    return kind;
}

/// The material of a piece stands beside its shape or in it.
const NamedMaterial& materialOf(const Node& piece, const Node& shape, const std::string& path, const std::vector<NamedMaterial>& materials)
{
    const Node* outside = piece.find("material");
    const Node* name = shape.find("material");
    if (outside && name) fail(outside->location, fmt::format("{}.material: is given twice; remove one", path));
    if (outside) name = outside;
    std::vector<std::string> names;
    for (const NamedMaterial& m : materials) names.push_back(m.name);
    if (!name) {
        fail(piece.location, fmt::format("{}.material is missing; it is the name of one of materials{}", path,
                                         names.empty() ? ", like material: wool" : suggestion("", names)));
    }
    const std::string& text = readText(*name, path + ".material");
    for (const NamedMaterial& m : materials) {
        if (m.name == text) return m;
    }
    fail(name->location, fmt::format("{}.material: materials has no {}{}", path, inQuotes(text), suggestion(text, names)));
}

/// Moves the points and turns the warp; returns the words of it.
std::string place(const Node& node, const std::string& path, FabricPiece& piece)
{
    std::string text;
    const auto apply = [&](const ReadTransform& read, const char* key) {
        for (Vec3& x : piece.points) x = read.transform * x;
        piece.warp = read.transform.linear() * piece.warp;
        text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", key, read.text);
    };
    SectionReader::read(&node, path, [](auto& v) {
        v.other("rotate", "Turns it, about its middle unless origin says another point");
        v.other("translate", "Moves it");
    });
    Eigen::AlignedBox3d bounds;
    for (const Vec3& x : piece.points) bounds.extend(x);
    if (const Node* turn = node.find("rotate")) apply(readRotation(*turn, joinPath(path, "rotate"), bounds.center()), "rotate");
    if (const Node* by = node.find("translate")) apply(readTranslation(*by, joinPath(path, "translate")), "translate");
    return "{" + text + "}";
}

void readPieceFields(const Node& node, const std::string& path, FabricPiece& piece)
{
    SectionReader::read(&node, path, [&](auto& v) {
        v.other("name", "What motions, forces and probes call it");
        v.text("group", piece.group, "Another name for motions, which several pieces may share");
        v.other("material", "Name of one of materials");
        for (const std::string& kind : fabricShapeKinds()) v.other(kind.c_str(), "");
        v.vector("velocity", piece.velocity, Quantity::Velocity, "At the start");
        v.other("pin", "Vertices that are held, or moved");
        v.other("transform", "Where it lies, after what makes it");
        v.number("wetness", piece.wetness, Quantity::None, Range::between(0.0, 1.0), "Share of the pores that liquid fills at the start");
    });
    if (const Node* group = node.find("group")) requireName(piece.group, group->location, path + ".group");
}

FabricPiece readPiece(const Node& node, const std::string& name, const std::string& path, const Scene& scene)
{
    FabricPiece piece;
    piece.name = name;
    piece.where = node.location.text();
    readPieceFields(node, path, piece);
    const std::string kind = piece.kind = kindOf(node, path);
    const NamedMaterial& material = materialOf(node, *node.find(kind), path, scene.materials);
    ReadFabricShape shape = readFabricShape(*node.find(kind), joinPath(path, kind), kind, material.material.thickness);
    piece.materialName = material.name;
    piece.material = material.material;
    piece.radius = shape.radius;
    piece.notes = std::move(shape.notes);
    piece.text = fmt::format("{{material: {}, {}", Node::scalar(material.name, {}).flow(), shape.text.substr(1));
    piece.points = shape.geometry.points;
    piece.warp = shape.warp;
    if (const Node* transform = node.find("transform")) piece.transformText = place(*transform, joinPath(path, "transform"), piece);
    if (const Node* pin = node.find("pin")) piece.pins = readPins(*pin, joinPath(path, "pin"), shape.geometry, piece.points, scene.settings.cell);
    piece.inFile = firstInFile(shape.geometry);
    piece.strands = std::move(shape.geometry.strands);
    piece.faces = std::move(shape.geometry.faces);
    return piece;
}

}  // namespace

std::vector<FabricPiece> readFabrics(const Node& root, const Scene& scene)
{
    std::vector<FabricPiece> pieces;
    const Node* list = listAt(&root, "fabrics", "fabrics", "[{cloth_grid: …}]");
    std::size_t vertices = 0;
    for (std::size_t i = 0; list && i < list->items.size(); ++i) {
        const std::string name = nameIn(list->items[i], i, "fabrics");
        const FabricPiece& piece = pieces.emplace_back(readPiece(list->items[i], name, joinPath("fabrics", name), scene));
        assembleFabric({&piece, 1});  // complains about what is no fabric
        vertices += piece.points.size();
        if (const int most = root.location.source->bounds.vertices; vertices > static_cast<std::size_t>(most))
            fail(piece.where, fmt::format("fabrics: together have {} vertices; at most {} are possible", vertices, most));
    }
    requireUnique(pieces, "fabrics");
    return pieces;
}

}  // namespace sim
