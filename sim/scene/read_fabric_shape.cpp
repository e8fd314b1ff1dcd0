#include "sim/fabric/pieces/orient.h"
#include "sim/scene/choice.h"
#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_place.h"
#include "sim/scene/section_reader.h"
#include "sim/shapes/mend_solid.h"
#include "sim/shapes/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

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

    [[noreturn]] void fail(const std::string& message) const { sim::fail(node.place, path + ": " + message); }
    int mostVertices() const { return node.place.source->bounds.vertices; }
};

/// The fields that every kind has.
template <class V>
void describeThread(V& v, std::array<double, 2>& radius)
{
    v.other("material", "Name of one of materials");
    v.needs("radius", "half the thickness of a yarn or of the cloth, like radius: 0.02; [a, b] is an elliptic section");
    v.numberOrPair("radius", radius, Quantity::Length, kSize, "");
}

/// Where a sheet lies: from a corner, or around its middle, along two directions.
struct Placement {
    Vec3 origin = Vec3::Zero(), center = Vec3::Zero(), u = Vec3::UnitX(), v = Vec3::UnitZ();
    bool byCenter = false;
};

template <class V>
void describe(V& v, Placement& p)
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
    std::array<double, 2> radius{}, size{};
    bool bySize = false;
    const auto fields = [&](auto& v) {
        describeThread(v, radius);
        v.needs("nodes", "the number of vertices each way, like nodes: [50, 50]");
        v.counts("nodes", grid.nodes, 2, context.mostVertices(), "");
        v.whenReading([&](auto& r) {
            bySize = r.has("size");
            if (bySize == r.has("spacing")) context.fail("needs either spacing or size");
        });
        v.when(!bySize, [&](auto& w) { w.numberOrPair("spacing", grid.spacing, Quantity::Length, kSize, ""); });
        v.when(bySize, [&](auto& w) { w.numberOrPair("size", size, Quantity::Length, kSize, ""); });
        describe(v, placement);
    };
    SectionReader::read(&context.node, context.path, fields);
    requireFew(pointCount(grid), context);
    const std::string text = flowOf(fields);
    for (int axis = 0; axis < 2; ++axis) {
        if (bySize) grid.spacing[axis] = size[axis] / (grid.nodes[axis] - 1);
        size[axis] = grid.spacing[axis] * (grid.nodes[axis] - 1);
    }
    place(placement, size[0], size[1], context, grid);
    return {clothGrid(grid), radius, text};
}

ReadFabricShape readWovenYarns(const Context& context)
{
    WovenYarns cloth;
    Placement placement;
    std::array<double, 2> radius{};
    const auto fields = [&](auto& v) {
        describeThread(v, radius);
        v.needs("yarns", "their number along u and along v, the border included, like yarns: [50, 50]");
        v.counts("yarns", cloth.yarns, 3, context.mostVertices(), "");
        v.needs("spacing", "the distance from yarn to yarn, like spacing: 0.144");
        v.number("spacing", cloth.spacing, Quantity::Length, kSize, "");
        v.whenReading([&](auto&) { cloth.amplitude = 0.5 * cloth.spacing; });
        v.number("amplitude", cloth.amplitude, Quantity::Length, Range::between(0.0, kFarthest), "");
        v.choice("weave", cloth.weave, "");
        v.flag("borders", cloth.borders, "");
        describe(v, placement);
    };
    SectionReader::read(&context.node, context.path, fields);
    requireFew(pointCount(cloth), context);
    place(placement, cloth.spacing * (cloth.yarns[1] - 1), cloth.spacing * (cloth.yarns[0] - 1), context, cloth);
    return {wovenYarns(cloth), radius, flowOf(fields)};
}

std::vector<Vec3> readPoints(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.size() < 2)
        fail(node.place, fmt::format("{}: needs two or more points, like [[0, 0, 0], [1, 0, 0]], not {}", path, node.called()));
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
        v.other("points", "");
        v.when(!points, [&](auto& w) {
            w.whenReading([&](auto& r) {
                const int given = r.has("from") + r.has("to") + r.has("segments");
                if (points ? given > 0 : given < 3) context.fail("needs either points, or from, to and segments");
            });
            w.vector("from", from, Quantity::Length, "");
            w.vector("to", to, Quantity::Length, "");
            w.integer("segments", segments, 1, context.mostVertices() - 1, "");
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

/// Every point has its own vertex of the file.
std::vector<int> asInFile(const FabricGeometry& mesh)
{
    std::vector<int> numbers(mesh.points.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

std::array<int, 3> sortedCorners(const Vec3i& face)
{
    std::array<int, 3> corners = {face[0], face[1], face[2]};
    std::ranges::sort(corners);
    return corners;
}

bool isNothing(const std::array<int, 3>& corners) { return corners[0] == corners[1] || corners[1] == corners[2]; }

/// Corners at one place become one; faces that lose a corner go, and so do those that are another's double then. Returns the number of
/// corners that went up in others.
std::size_t weld(FabricGeometry& mesh, double distance)
{
    const std::vector<int> number = weldedNumbers(mesh.points, distance);
    std::vector<bool> isGone(mesh.points.size(), false);
    std::set<std::array<int, 3>> known, knownInFile;
    std::erase_if(mesh.faces, [&](Vec3i& f) {
        // What is wrong in the file already stays, and is told as that.
        const std::array<int, 3> before = sortedCorners(f);
        for (int& corner : f) {
            if (number[corner] != corner) isGone[corner] = true;
            corner = number[corner];
        }
        const std::array<int, 3> corners = sortedCorners(f);
        const bool isNew = known.insert(corners).second, wasNew = knownInFile.insert(before).second;
        return (isNothing(corners) && !isNothing(before)) || (!isNew && wasNew);
    });
    for (int& point : mesh.ofFile) point = point < 0 ? point : number[point];
    return static_cast<std::size_t>(std::ranges::count(isGone, true));
}

/// Points that no face and no strand has go. Returns their number.
std::size_t dropUnused(FabricGeometry& mesh)
{
    std::vector<int> number(mesh.points.size(), -1);
    for (const Vec3i& f : mesh.faces)
        for (const int corner : f) number[corner] = 0;
    for (const std::vector<int>& strand : mesh.strands)
        for (const int point : strand) number[point] = 0;
    std::vector<Vec3> used;
    for (std::size_t p = 0; p < number.size(); ++p) {
        if (number[p] < 0) continue;
        number[p] = static_cast<int>(used.size());
        used.push_back(mesh.points[p]);
    }
    for (Vec3i& f : mesh.faces)
        for (int& corner : f) corner = number[corner];
    for (std::vector<int>& strand : mesh.strands)
        for (int& point : strand) point = number[point];
    for (int& point : mesh.ofFile) point = point < 0 ? point : number[point];
    const std::size_t dropped = mesh.points.size() - used.size();
    mesh.points = std::move(used);
    return dropped;
}

/// Faces none of whose corners another face has.
std::size_t loneFaces(const FabricGeometry& mesh)
{
    std::vector<int> faces(mesh.points.size(), 0);
    for (const Vec3i& f : mesh.faces)
        for (const int corner : f) ++faces[corner];
    return static_cast<std::size_t>(std::ranges::count_if(mesh.faces, [&](const Vec3i& f) {
        return std::max({faces[f[0]], faces[f[1]], faces[f[2]]}) == 1;
    }));
}

/// Where the scene does not say: far below any edge, above the rounding of single precision [cm].
double ownWeld(const std::vector<Vec3>& points)
{
    constexpr double kOfSize = 1.0e-6;
    Eigen::AlignedBox3d box;
    for (const Vec3& x : points) box.extend(x);
    return points.empty() ? 0.0 : kOfSize * box.sizes().maxCoeff();
}

/// Drops what is not used, joins what is at one place, and says so.
/// @param distance  of corners that are one [cm]; 0: none are; negative: the mesh's own
std::vector<std::string> tidy(FabricGeometry& mesh, double distance)
{
    std::vector<std::string> notes;
    mesh.ofFile = asInFile(mesh);
    const std::size_t before = mesh.faces.size(), unused = dropUnused(mesh);
    if (distance < 0.0) distance = ownWeld(mesh.points);
    const std::size_t welded = distance > 0.0 ? weld(mesh, distance) : 0;
    dropUnused(mesh);
    const std::size_t gone = before - mesh.faces.size(), lone = mesh.faces.size() > 1 ? loneFaces(mesh) : 0;
    if (unused > 0) notes.push_back(fmt::format("{} of its vertices are in no {} and left out", unused, mesh.strands.empty() ? "face" : "line"));
    if (welded > 0)
        notes.push_back(fmt::format("{} of its vertices are welded to others within {:.3g} cm{}; weld: 0 would leave them apart", welded, distance,
                                    gone > 0 ? fmt::format(", and {} faces that are nothing or doubled then are left out", gone) : ""));
    if (lone > 0)
        notes.push_back(fmt::format("{} of its {} triangles share no vertex with another and will fall apart; a larger weld would join them", lone,
                                    mesh.faces.size()));
    return notes;
}

ReadFabricShape readFile(const Context& context, bool isCloth)
{
    std::array<double, 2> radius{};
    std::string file;
    constexpr double kUnset = -1.0;
    double weldDistance = kUnset;
    double scale = parseNumber("1", Quantity::Length, context.node.place.source && context.node.place.source->isSi).value;
    const auto fields = [&](auto& v) {
        describeThread(v, radius);
        v.needs("file", isCloth ? "an OBJ file, relative to the scene, like file: shirt.obj"
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
        if (isCloth) {
            TriangleMesh mesh = readObj(path);
            out.points = std::move(mesh.vertices);
            out.faces = std::move(mesh.triangles);
        } else {
            PolylineSet lines = readObjLines(path);
            out.points = std::move(lines.vertices);
            out.strands = std::move(lines.lines);
        }
    } catch (const InputError& e) {
        fail(name.place, fmt::format("{}: {}", context.path, e.what()));
    }
    for (Vec3& x : out.points) {
        x *= scale;
        requireNear(name, context.path, x);
    }
    std::vector<std::string> notes = tidy(out, isCloth ? weldDistance : 0.0);
    if (isCloth && out.faces.empty())
        fail(context.node.find("weld") ? context.node.find("weld")->place : name.place, context.path + ".weld: leaves no triangle; ask for less");
    for (std::string& note : notes) note = fmt::format("{}: {}.file: {}", name.place.text(), context.path, note);
    requireFew(static_cast<double>(out.points.size()), context);
    if (const std::string problem = orientAlike(out.faces, firstInFile(out)); !problem.empty())
        fail(name.place, fmt::format("{}.file: {}", context.path, problem));
    return {std::move(out), radius, flowOf(fields), std::move(notes)};
}

}  // namespace

const std::vector<std::string>& fabricShapeKinds()
{
    static const std::vector<std::string> kKinds = {"cloth_grid", "woven_yarns", "strand", "mesh", "points"};
    return kKinds;
}

ReadFabricShape readFabricShape(const Node& node, const std::string& path, const std::string& kind)
{
    const Context context{node, path};
    if (kind == "cloth_grid") return readClothGrid(context);
    if (kind == "woven_yarns") return readWovenYarns(context);
    if (kind == "strand") return readStrand(context);
    return readFile(context, kind == "mesh");
}

}  // namespace sim
