#include "app/import/lattice_fit.h"
#include "app/import/recognise.h"
#include "sim/scene/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace app {

using sim::Vec2i;
using sim::Vec3;
using sim::Weave;
using sim::WovenYarns;

namespace {

constexpr std::size_t kFewPoints = 24;  // more go to a file of their own

struct NamedWeave {
    Weave weave;
    const char* name;
};
constexpr NamedWeave kWeaves[] = {{Weave::Plain, "plain"}, {Weave::Twill, "twill"}, {Weave::Herringbone, "herringbone"}};

/// Listed vertex of each generated one, where both have the same yarns; else nothing.
std::optional<std::vector<int>> matchYarns(const sim::FabricGeometry& generated, const ListedFabric& listed)
{
    if (generated.strands.size() != listed.strands.size() || generated.points.size() != listed.points.size()) return std::nullopt;
    std::vector<int> pointOf(generated.points.size(), -1);
    for (std::size_t s = 0; s < generated.strands.size(); ++s) {
        if (generated.strands[s].size() != listed.strands[s].size()) return std::nullopt;
        for (std::size_t i = 0; i < generated.strands[s].size(); ++i) {
            int& point = pointOf[generated.strands[s][i]];
            if (point >= 0 && point != listed.strands[s][i]) return std::nullopt;
            point = listed.strands[s][i];
        }
    }
    if (std::set<int>(pointOf.begin(), pointOf.end()).size() != pointOf.size()) return std::nullopt;
    return pointOf;
}

/// Heights of the vertices in amplitudes: 1 above, −1 below, 0 at the corners, which lie between.
std::vector<double> heightsOf(WovenYarns cloth)
{
    cloth.spacing = cloth.amplitude = 1.0;
    std::vector<double> heights;
    for (const Vec3& x : sim::wovenYarns(cloth).points) heights.push_back(x[1]);
    return heights;
}

/// The weave through points in the generator's order, its numbers rounded to what a file would say.
WovenYarns weaveThrough(WovenYarns cloth, std::span<const Vec3> points, std::span<const Vec2i> places)
{
    const LatticeFit fit = fitLattice(points, places, heightsOf(cloth));
    cloth.spacing = shortest(fit.u.norm());
    cloth.origin = shortest(fit.origin);
    cloth.u = shortest(Vec3(fit.u.normalized()));
    cloth.v = shortest(Vec3(fit.v.normalized()));
    cloth.amplitude = shortest(fit.w.dot(cloth.v.cross(cloth.u).normalized()));
    return cloth;
}

GeneratedFabric generated(const WovenYarns& cloth, const char* weave)
{
    GeneratedFabric out;
    out.kind = "woven_yarns";
    out.fields = {{"yarns", fmt::format("[{}, {}]", cloth.yarns[0], cloth.yarns[1])},
                  {"spacing", sim::formatPlain(cloth.spacing)},
                  {"amplitude", sim::formatPlain(cloth.amplitude)},
                  {"weave", weave},
                  {"borders", cloth.borders ? "true" : "false"},
                  {"origin", yamlList(cloth.origin)},
                  {"u", yamlList(cloth.u)},
                  {"v", yamlList(cloth.v)}};
    out.summary = fmt::format("{} by {} yarns, {} cm apart, {}{}", cloth.yarns[0], cloth.yarns[1], out.fields[1].second, weave,
                              cloth.borders ? " with borders" : "");
    out.geometry = sim::wovenYarns(cloth);
    return out;
}

std::optional<GeneratedFabric> recogniseWeaveOf(const WovenYarns& size, const ListedFabric& fabric)
{
    const sim::FabricGeometry pattern = sim::wovenYarns(size);
    const std::optional<std::vector<int>> pointOf = matchYarns(pattern, fabric);
    if (!pointOf) return std::nullopt;
    std::vector<Vec3> points;
    for (const int p : *pointOf) points.push_back(fabric.points[p]);
    for (const auto& [weave, name] : kWeaves) {
        WovenYarns cloth = size;
        cloth.weave = weave;
        cloth = weaveThrough(cloth, points, pattern.lattice);
        if (!(cloth.spacing > 0.0 && cloth.amplitude >= 0.0)) continue;
        GeneratedFabric out = generated(cloth, name);
        out.pointOf = *pointOf;
        out.deviation = largestDistance(points, out.geometry.points);
        if (out.deviation < kSameShape) return out;
    }
    return std::nullopt;
}

GeneratedFabric strandOf(const ListedFabric& fabric, std::vector<std::pair<std::string, std::string>> fields, sim::FabricGeometry geometry)
{
    GeneratedFabric out;
    out.kind = "strand";
    out.fields = std::move(fields);
    out.summary = fmt::format("{} vertices", fabric.points.size());
    out.geometry = std::move(geometry);
    out.pointOf = fabric.strands[0];
    std::vector<Vec3> listed;
    for (const int p : out.pointOf) listed.push_back(fabric.points[p]);
    out.deviation = largestDistance(listed, out.geometry.points);
    return out;
}

}  // namespace

std::optional<GeneratedFabric> recogniseWeave(const ListedFabric& fabric)
{
    if (fabric.strands.empty() || !fabric.faces.empty()) return std::nullopt;
    const int count = static_cast<int>(fabric.strands.size()), columns = static_cast<int>(fabric.strands[0].size());
    for (const bool borders : {true, false}) {
        WovenYarns size;
        size.yarns = Vec2i(borders ? count - columns : count - columns + 4, columns);
        size.borders = borders;
        if (size.yarns.minCoeff() < 3 || sim::pointCount(size) != static_cast<double>(fabric.points.size())) continue;
        if (auto out = recogniseWeaveOf(size, fabric)) return out;
    }
    return std::nullopt;
}

std::optional<GeneratedFabric> recogniseStrand(const ListedFabric& fabric)
{
    if (fabric.strands.size() != 1 || !fabric.faces.empty() || fabric.strands[0].size() != fabric.points.size()) return std::nullopt;
    const std::vector<int>& strand = fabric.strands[0];
    const Vec3 &from = fabric.points[strand.front()], &to = fabric.points[strand.back()];
    const int segments = static_cast<int>(strand.size()) - 1;
    if ((to - from).norm() > 0.0) {
        GeneratedFabric out = strandOf(fabric, {{"from", yamlList(from)}, {"to", yamlList(to)}, {"segments", std::to_string(segments)}},
                                       sim::strand(from, to, segments));
        if (out.deviation < kSameShape) return out;
    }
    if (fabric.points.size() > kFewPoints) return std::nullopt;
    std::vector<Vec3> points;
    std::string text;
    for (const int p : strand) {
        points.push_back(fabric.points[p]);
        text += (text.empty() ? "" : ", ") + yamlList(points.back());
    }
    return strandOf(fabric, {{"points", "[" + text + "]"}}, sim::strand(points));
}

}  // namespace app
