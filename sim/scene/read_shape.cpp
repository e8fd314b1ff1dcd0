#include "sim/scene/read_shape.h"

#include "sim/scene/read_place.h"
#include "sim/scene/section_reader.h"
#include "sim/shapes/obj.h"

#include <fmt/format.h>

#include <filesystem>

namespace sim {

namespace {

struct Context {
    std::string path;
    double cell = 0.0;
};

const Range kSize = Range::aboveTo(0.0, kFarthest);
const Range kRound = Range::between(0.0, kFarthest);

ReadShape readBox(const Node& node, const Context& context, bool isRound)
{
    Vec3 center = Vec3::Zero(), half = Vec3::Zero(), low = Vec3::Zero(), high = Vec3::Zero();
    double round = 0.0;
    const auto fields = [&](auto& v) {
        v.vector("center", center, Quantity::Length, "The middle");
        v.vector("half", half, Quantity::Length, "Half of the edges, with center");
        v.when(false, [&](auto& w) {
            w.vector("min", low, Quantity::Length, "Lowest corner, with max, in the place of center and half");
            w.vector("max", high, Quantity::Length, "Highest corner");
        });
        if (isRound) v.required("round", "the radius of the edges, added outside of half");
        if (isRound) v.number("round", round, Quantity::Length, kRound, "");
        v.whenReading([&](auto& r) {
            const bool byCenter = r.has("center") && r.has("half"), byCorners = r.has("min") && r.has("max");
            const int given = r.has("center") + r.has("half") + r.has("min") + r.has("max");
            if (given != 2 || byCenter == byCorners)
                fail(node.location, fmt::format("{}: needs either center and half, or min and max", context.path));
            if (byCorners) {
                center = 0.5 * (low + high);
                half = 0.5 * (high - low);
            }
            const bool hasSize = half.minCoeff() > 0.0 || (half.minCoeff() >= 0.0 && round > 0.0);
            r.require(hasSize, byCorners ? "max" : "half",
                      byCorners ? "must be above min in every direction" : "must be above 0 cm in every direction");
        });
    };
    SectionReader::read(&node, context.path, fields);
    requireNear(node, context.path, center.cwiseAbs() + half);
    return {isRound ? Shape::roundedBox(center, half, round) : Shape::box(center, half), flowOf(fields)};
}

ReadShape readBall(const Node& node, const Context& context)
{
    Vec3 center = Vec3::Zero();
    double radius = 0.0;
    const auto fields = [&](auto& v) {
        v.required("center", "the middle of the ball, like center: [0, 5, 0]");
        v.vector("center", center, Quantity::Length, "");
        v.required("radius", "the size of the ball, like radius: 1.44");
        v.number("radius", radius, Quantity::Length, kSize, "");
    };
    SectionReader::read(&node, context.path, fields);
    requireNear(node, context.path, center);
    return {Shape::ball(center, radius), flowOf(fields)};
}

ReadShape readCapsule(const Node& node, const Context& context)
{
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    double radius = 0.0;
    const auto fields = [&](auto& v) {
        v.required("a", "one end of the axis, like a: [0, 0, 0]");
        v.vector("a", a, Quantity::Length, "");
        v.required("b", "the other end of the axis, like b: [2, 0, 0]");
        v.vector("b", b, Quantity::Length, "");
        v.required("radius", "the distance of the surface from the axis, like radius: 0.5");
        v.number("radius", radius, Quantity::Length, kSize, "");
    };
    SectionReader::read(&node, context.path, fields);
    requireNear(node, context.path, a.cwiseAbs().cwiseMax(b.cwiseAbs()));
    return {Shape::capsule(a, b, radius), flowOf(fields)};
}

ReadShape readCylinder(const Node& node, const Context& context)
{
    Vec3 center = Vec3::Zero(), axis = Vec3::UnitY();
    double radius = 0.0, half = 0.0, round = 0.0;
    const auto fields = [&](auto& v) {
        v.required("center", "the middle of the cylinder, like center: [0, 5, 0]");
        v.vector("center", center, Quantity::Length, "");
        v.vector("axis", axis, Quantity::None, "Direction of the height");
        v.required("radius", "the distance of the side from the axis, like radius: 0.5");
        v.number("radius", radius, Quantity::Length, kSize, "");
        v.required("half", "half of the height, like half: 2");
        v.number("half", half, Quantity::Length, kSize, "");
        v.number("round", round, Quantity::Length, kRound, "Radius of the rims");
        v.require(round <= radius, "round", "must not be above radius");
    };
    SectionReader::read(&node, context.path, fields);
    requireNear(node, context.path, center);
    return {Shape::cylinder(center, unitAxis(node, context.path + ".axis", axis), radius, half, round), flowOf(fields)};
}

ReadShape readMesh(const Node& node, const Context& context)
{
    std::string file;
    double scale = parseNumber("1", Quantity::Length, node.location.source && node.location.source->isSi).value, cell = 0.5 * context.cell;
    const auto fields = [&](auto& v) {
        v.required("file", "an OBJ file, relative to the scene, like file: cow.obj");
        v.text("file", file, "");
        v.number("scale", scale, Quantity::Length, kSize, "Length of the unit of the file");
        v.number("cell", cell, Quantity::Length, kSize, "Pitch of the distances that are kept; left out: half of grid.cell");
        v.unsupported("cache", "this version finds the distances of a mesh anew in every run; remove the key (a larger mesh.cell is faster)");
    };
    SectionReader::read(&node, context.path, fields);
    if (!(cell > 0.0)) fail(node.location, fmt::format("{}.cell is missing; it is the pitch of the distance field, like cell: 0.1", context.path));
    const Node& name = *node.find("file");
    const std::filesystem::path path = existingFile(name, context.path + ".file");
    file = path.string();
    try {
        std::vector<std::string> notes;
        Shape shape = shapeFromObj(path, scale, cell, &notes);
        for (std::string& note : notes) note = fmt::format("{}: {}.file: {}", name.location.text(), context.path, note);
        return {std::move(shape), flowOf(fields), std::move(notes)};
    } catch (const InputError& e) {
        fail(name.location, fmt::format("{}: {}", context.path, e.what()));
    }
}

ReadShape readParts(const Node& node, const Context& context, const std::string& operation)
{
    if (!node.isList() || node.items.empty()) fail(node.location, fmt::format("{}: needs a list of shapes, not {}", context.path, node.called()));
    std::vector<Shape> shapes;
    std::string texts;
    std::vector<std::string> notes;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        ReadShape part = readShape(node.items[i], joinPath(context.path, std::to_string(i)), context.cell);
        shapes.push_back(std::move(part.shape));
        notes.insert(notes.end(), part.notes.begin(), part.notes.end());
        texts += (i > 0 ? ", " : "") + part.text;
    }
    const std::string text = "[" + texts + "]";
    if (operation == "union") return {Shape::unite(shapes), text, notes};
    if (operation == "intersect") return {Shape::intersect(shapes), text, notes};
    return {Shape::subtract(shapes), text, notes};
}

ReadShape readBody(const Node& node, const Context& context, const std::string& kind)
{
    if (kind == "box") return readBox(node, context, false);
    if (kind == "rounded_box") return readBox(node, context, true);
    if (kind == "ball") return readBall(node, context);
    if (kind == "capsule") return readCapsule(node, context);
    if (kind == "cylinder") return readCylinder(node, context);
    if (kind == "mesh") return readMesh(node, context);
    if (kind != "invert") return readParts(node, context, kind);
    ReadShape inner = readShape(node, context.path, context.cell);
    return {inner.shape.inverted(), inner.text, inner.notes};
}

/// Where the shape turns unless it says so: the middle of its bounds, the scene's origin where it has none.
Vec3 middleOf(const Shape& shape)
{
    const Eigen::AlignedBox3d bounds = shape.bounds();
    if (bounds.isEmpty() || !(bounds.sizes().maxCoeff() < kFarthest)) return Vec3::Zero();
    return bounds.center();
}

void apply(const ReadTransform& transform, const char* key, ReadShape& body)
{
    body.shape = body.shape.moved(transform.transform);
    body.text += fmt::format(", {}: {}", key, transform.text);
}

/// The one key of the shape that says what body it is.
std::string shapeKind(const Node& node, const std::string& path)
{
    if (!node.isMap())
        fail(node.location, fmt::format("{}: needs a shape like {{ball: {{center: [0, 5, 0], radius: 1}}}}, not {}", path, node.called()));
    std::vector<std::string> known = shapeKinds();
    known.insert(known.end(), {"rotate", "translate"});
    SectionReader(node, path).refuseKeysBut(known);
    std::string kind;
    for (const std::string& candidate : shapeKinds()) {
        if (!node.find(candidate)) continue;
        if (!kind.empty()) fail(node.location, fmt::format("{}: has both {} and {}; put them into a union", path, kind, candidate));
        kind = candidate;
    }
    if (kind.empty()) fail(node.location, fmt::format("{}: names no body; it takes one of {}", path, listed(shapeKinds())));
    return kind;
}

}  // namespace

const std::vector<std::string>& shapeKinds()
{
    static const std::vector<std::string> kKinds = {"box",  "rounded_box", "ball",      "capsule",  "cylinder",
                                                    "mesh", "union",       "intersect", "subtract", "invert"};
    return kKinds;
}

ReadShape readShape(const Node& node, const std::string& path, double cell)
{
    const std::string kind = shapeKind(node, path);
    const Node& given = *node.find(kind);
    ReadShape body = readBody(given, {joinPath(path, kind), cell}, kind);
    body.text = kind + ": " + body.text;
    if (const Node* turn = node.find("rotate")) apply(readRotation(*turn, joinPath(path, "rotate"), middleOf(body.shape)), "rotate", body);
    if (const Node* by = node.find("translate")) apply(readTranslation(*by, joinPath(path, "translate")), "translate", body);
    body.text = "{" + body.text + "}";
    return body;
}

}  // namespace sim
