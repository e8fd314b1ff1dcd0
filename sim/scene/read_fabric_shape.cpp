#include "sim/fabric/pieces/orient.h"
#include "sim/fabric/pieces/tidy_mesh.h"
#include "sim/scene/choice.h"
#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_place.h"
#include "sim/scene/section_reader.h"
#include "sim/shapes/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sim {

static std::span<const Choice<Weave>> choicesOf(Weave)
{
    static constexpr Choice<Weave> kAll[] = {{"plain", Weave::Plain}, {"twill", Weave::Twill}, {"herringbone", Weave::Herringbone}};
    return kAll;
}

namespace {

const Range kSize = Range::aboveTo(0.0, kFarthest);

struct Context {
    const Node& node;
    std::string path;
    double thickness = 0.0;  ///< of the material's cloth; 0: it has none [cm]

    [[noreturn]] void fail(const std::string& message) const { sim::fail(node.location, path + ": " + message); }
    int mostVertices() const { return node.location.source->bounds.vertices; }
};

/// The fields that every kind of yarns has.
template <class V>
void describeThread(V& v, std::array<double, 2>& radius)
{
    v.other("material", "Name of one of materials");
    v.required("radius", "half the thickness of a yarn or of the cloth, like radius: 0.02; [a, b] is an elliptic section");
    v.numberOrPair("radius", radius, Quantity::Length, kSize, "");
}

/// What says how thick cloth is, and where its warp runs.
struct Sheet {
    std::array<double, 2> radius{};  ///< [cm]
    Vec3 warp = Vec3::UnitX();
    bool hasWarp = false;  ///< the scene says which
};

template <class V>
void describeSheet(V& v, Sheet& sheet, const Context& context)
{
    v.other("material", "Name of one of materials");
    v.whenReading([&](auto& r) {
        sheet.radius.fill(0.5 * context.thickness);
        if (!(context.thickness > 0.0))
            r.required("radius", "half the thickness of the cloth, like radius: 0.02, where its material has no thickness");
        sheet.hasWarp = r.has("warp");
    });
    v.numberOrPair("radius", sheet.radius, Quantity::Length, kSize, "Half the thickness of the cloth; left out: of its material");
    v.when(sheet.hasWarp, [&](auto& w) { w.vector("warp", sheet.warp, Quantity::None, "Direction of the warp; left out: the first axis"); });
    v.whenReading([&](auto& r) {
        if (sheet.hasWarp) sheet.warp = unitAxis(*r.find("warp"), context.path + ".warp", sheet.warp);
    });
}

/// Where a sheet lies: from a corner, or around its middle, along two directions.
struct Placement {
    Vec3 origin = Vec3::Zero(), center = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitZ();
    bool byCenter = false;
};

template <class V>
void visitFields(V& v, Placement& p)
{
    v.whenReading([&](auto& r) {
        p.byCenter = r.has("center");
        r.require(!p.byCenter || !r.has("origin"), "center", "stands for origin; give one of them");
    });
    v.when(!p.byCenter, [&](auto& w) { w.vector("origin", p.origin, Quantity::Length, "The corner"); });
    v.when(p.byCenter, [&](auto& w) { w.vector("center", p.center, Quantity::Length, "The middle"); });
    v.vector("u", p.u, Quantity::None, "Direction of the first");
    v.vector("v", p.v, Quantity::None, "Direction of the second");
}

/// Fills origin, u and v of a sheet of that extent.
template <class Sheet>
void place(const Placement& p, double alongU, double alongV, const Context& context, Sheet& sheet)
{
    sheet.u = unitAxis(context.node, context.path + ".u", p.u);
    sheet.v = unitAxis(context.node, context.path + ".v", p.v);
    constexpr double kSmallestAngle = 1.0e-3;  // [rad]
    if (sheet.u.cross(sheet.v).norm() < kSmallestAngle) context.fail("u and v must point in different directions");
    sheet.origin = p.byCenter ? Vec3(p.center - 0.5 * (alongU * sheet.u + alongV * sheet.v)) : p.origin;
    requireNear(context.node, context.path, sheet.origin.cwiseAbs() + Vec3::Constant(std::max(alongU, alongV)));
}

void requireFew(double count, const Context& context)
{
    const double most = context.mostVertices();
    if (count > most) context.fail(fmt::format("would have {:.3g} vertices (at most {:.0e} are possible); ask for fewer", count, most));
}

ReadFabricShape readClothGrid(const Context& context)
{
    ClothGrid grid;
    Placement placement;
    Sheet sheet;
    std::array<double, 2> size{};
    bool bySize = false;
    const auto fields = [&](auto& v) {
        describeSheet(v, sheet, context);
        v.required("nodes", "the number of vertices each way, like nodes: [50, 50]");
        v.counts("nodes", grid.nodes, 2, context.mostVertices(), "");
        v.whenReading([&](auto& r) {
            bySize = r.has("size");
            if (bySize == r.has("spacing")) context.fail("needs either spacing or size");
        });
        v.when(!bySize, [&](auto& w) {
            w.numberOrPair("spacing", grid.spacing, Quantity::Length, kSize, "Distance from vertex to vertex, or [along u, along v]");
        });
        v.when(bySize, [&](auto& w) { w.numberOrPair("size", size, Quantity::Length, kSize, "Length of the sides, in the place of spacing"); });
        visitFields(v, placement);
    };
    SectionReader::read(&context.node, context.path, fields);
    requireFew(pointCount(grid), context);
    const std::string text = flowOf(fields);
    for (int axis = 0; axis < 2; ++axis) {
        if (bySize) grid.spacing[axis] = size[axis] / (grid.nodes[axis] - 1);
        size[axis] = grid.spacing[axis] * (grid.nodes[axis] - 1);
    }
    place(placement, size[0], size[1], context, grid);
    return {clothGrid(grid), sheet.radius, text, sheet.hasWarp ? sheet.warp : grid.u};
}

ReadFabricShape readWovenYarns(const Context& context)
{
    WovenYarns cloth;
    Placement placement;
    std::array<double, 2> radius{};
    const auto fields = [&](auto& v) {
        describeThread(v, radius);
        v.required("yarns", "their number along u and along v, the border included, like yarns: [50, 50]");
        v.counts("yarns", cloth.yarns, 3, context.mostVertices(), "");
        v.required("spacing", "the distance from yarn to yarn, like spacing: 0.144");
        v.number("spacing", cloth.spacing, Quantity::Length, kSize, "");
        v.whenReading([&](auto&) { cloth.amplitude = 0.5 * cloth.spacing; });
        v.number("amplitude", cloth.amplitude, Quantity::Length, Range::between(0.0, kFarthest),
                 "How far yarns go up and down; left out: half of spacing");
        v.choice("weave", cloth.weave, "Which yarns go over which");
        v.flag("borders", cloth.borders, "Yarns along the rim, too");
        visitFields(v, placement);
    };
    SectionReader::read(&context.node, context.path, fields);
    requireFew(pointCount(cloth), context);
    place(placement, cloth.spacing * (cloth.yarns[1] - 1), cloth.spacing * (cloth.yarns[0] - 1), context, cloth);
    return {wovenYarns(cloth), radius, flowOf(fields)};
}

std::vector<Vec3> readPoints(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.size() < 2)
        fail(node.location, fmt::format("{}: needs two or more points, like [[0, 0, 0], [1, 0, 0]], not {}", path, node.called()));
    std::vector<Vec3> points(node.items.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        readNumbers(node.items[i], path, {points[i].data(), 3}, Quantity::Length, Range::between(-kFarthest, kFarthest));
    return points;
}

ReadFabricShape readStrand(const Context& context)
{
    std::array<double, 2> radius{};
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    int segments = 0;
    const Node* points = context.node.find("points");
    const auto fields = [&](auto& v) {
        describeThread(v, radius);
        v.other("points", "Corners of the yarn, or from, to and segments");
        v.when(!points, [&](auto& w) {
            w.whenReading([&](auto& r) {
                const int given = r.has("from") + r.has("to") + r.has("segments");
                if (points ? given > 0 : given < 3) context.fail("needs either points, or from, to and segments");
            });
            w.vector("from", from, Quantity::Length, "One end of a straight yarn");
            w.vector("to", to, Quantity::Length, "The other end");
            w.integer("segments", segments, 1, context.mostVertices() - 1, "Edges of a straight yarn");
        });
    };
    SectionReader::read(&context.node, context.path, fields);
    std::string text = flowOf(fields);
    if (!points) {
        requireNear(context.node, context.path, from.cwiseAbs().cwiseMax(to.cwiseAbs()));
        if (!((to - from).norm() > 0.0)) context.fail("from and to are the same point");
        return {strand(from, to, segments), radius, text};
    }
    const std::vector<Vec3> all = readPoints(*points, context.path + ".points");
    text.pop_back();
    text += ", points: [";
    for (std::size_t i = 0; i < all.size(); ++i)
        text += fmt::format("{}[{}, {}, {}]", i > 0 ? ", " : "", formatPlain(all[i][0]), formatPlain(all[i][1]), formatPlain(all[i][2]));
    return {strand(all), radius, text + "]}"};
}

/// The points of an OBJ file with its faces, or with its lines as yarns.
FabricGeometry geometryIn(const std::filesystem::path& file, bool isCloth)
{
    FabricGeometry out;
    if (isCloth) {
        TriangleMesh mesh = readObj(file);
        out.points = std::move(mesh.vertices);
        out.faces = std::move(mesh.triangles);
    } else {
        PolylineSet lines = readObjLines(file);
        out.points = std::move(lines.vertices);
        out.strands = std::move(lines.lines);
    }
    return out;
}

ReadFabricShape readFile(const Context& context, bool isCloth)
{
    Sheet sheet;
    std::string file;
    constexpr double kUnset = -1.0;
    double weldDistance = kUnset;
    double scale = parseNumber("1", Quantity::Length, context.node.location.source && context.node.location.source->isSi).value;
    const auto fields = [&](auto& v) {
        if (isCloth) describeSheet(v, sheet, context);
        else describeThread(v, sheet.radius);
        v.required("file", isCloth ? "an OBJ file, relative to the scene, like file: shirt.obj"
                                   : "an OBJ file whose l lines are yarns, relative to the scene, like file: net.obj");
        v.text("file", file, "");
        v.number("scale", scale, Quantity::Length, kSize, "The file's unit");
        v.when(isCloth, [&](auto& w) {
            w.numberOr("weld", weldDistance, kUnset, Quantity::Length, Range::between(0.0, kFarthest), "Vertices no further apart are one");
        });
    };
    SectionReader::read(&context.node, context.path, fields);
    const Node& name = *context.node.find("file");
    const std::filesystem::path path = existingFile(name, context.path + ".file");
    file = path.string();
    FabricGeometry out;
    try {
        out = geometryIn(path, isCloth);
    } catch (const InputError& e) {
        fail(name.location, fmt::format("{}: {}", context.path, e.what()));
    }
    for (Vec3& x : out.points) {
        x *= scale;
        requireNear(name, context.path, x);
    }
    std::vector<std::string> notes = tidyMesh(out, isCloth ? weldDistance : 0.0);
    if (isCloth && out.faces.empty())
        fail(context.node.find("weld") ? context.node.find("weld")->location : name.location,
             context.path + ".weld: leaves no triangle; ask for less");
    for (std::string& note : notes) note = fmt::format("{}: {}.file: {}", name.location.text(), context.path, note);
    requireFew(static_cast<double>(out.points.size()), context);
    if (const std::string problem = orientAlike(out.faces, firstInFile(out)); !problem.empty())
        fail(name.location, fmt::format("{}.file: {}", context.path, problem));
    return {std::move(out), sheet.radius, flowOf(fields), sheet.warp, std::move(notes)};
}

}  // namespace

const std::vector<std::string>& fabricShapeKinds()
{
    static const std::vector<std::string> kKinds = {"cloth_grid", "woven_yarns", "strand", "mesh", "points"};
    return kKinds;
}

ReadFabricShape readFabricShape(const Node& node, const std::string& path, const std::string& kind, double thickness)
{
    const Context context{node, path, thickness};
    if (kind == "cloth_grid") return readClothGrid(context);
    if (kind == "woven_yarns") return readWovenYarns(context);
    if (kind == "strand") return readStrand(context);
    return readFile(context, kind == "mesh");
}

}  // namespace sim
