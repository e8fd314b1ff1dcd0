#include "app/frames/snapshot_fabric.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

using sim::Fabric;
using sim::FabricState;
using sim::Vec3;
using sim::Vec3i;

constexpr double kNone = -std::numeric_limits<double>::infinity();

void replaceNone(std::vector<double>& values)
{
    for (double& value : values)
        if (value == kNone) value = 0.0;
}

/// First axis of the section at the middle of a yarn edge.
Vec3 materialDirection(const FabricState& state, int edge)
{
    const Vec3 &u = state.reference[edge], &t = state.tangent[edge];
    return std::cos(state.theta[edge]) * u + std::sin(state.theta[edge]) * t.cross(u);
}

/// Direction of a strand at vertex j: between those of the edges on either side.
Vec3 directionAt(const Fabric& fabric, const FabricState& state, int strand, int j)
{
    const int before = fabric.strands.edgeBegin(strand) + j - 1, edges = fabric.strands.size(strand) - 1;
    Vec3 sum = Vec3::Zero();
    if (j > 0) sum += materialDirection(state, before);
    if (j < edges) sum += materialDirection(state, before + 1);
    const double length = sum.norm();
    return length > 0.0 ? Vec3(sum / length) : materialDirection(state, j > 0 ? before : before + 1);
}

/// Larger singular value of the map from the triangle at rest to the one it has become.
double largestStretch(const std::vector<Vec3>& rest, const std::vector<Vec3>& now, const Vec3i& face)
{
    const Vec3 e = rest[face[1]] - rest[face[0]], f = rest[face[2]] - rest[face[0]];
    const Vec3 a = now[face[1]] - now[face[0]], b = now[face[2]] - now[face[0]];
    // In the rest plane, e along the first axis: the edges are (length, 0) and (along, across).
    const double length = e.norm(), along = e.dot(f) / length, across = e.cross(f).norm() / length;
    const Vec3 first = a / length, second = (b - along * first) / across;
    const double xx = first.squaredNorm(), yy = second.squaredNorm(), xy = first.dot(second);
    return std::sqrt(0.5 * (xx + yy) + std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy));
}

/// What colours each vertex; empty where it is the material.
std::vector<double> vertexValues(FabricColorBy colorBy, const Fabric& fabric, const FabricState& state, const std::vector<float>& wetness,
                                 std::vector<double> (*strain)(const Fabric&, const FabricState&))
{
    if (colorBy == FabricColorBy::Material) return {};
    if (colorBy == FabricColorBy::Saturation)
        return wetness.empty() ? std::vector<double>(fabric.vertexCount(), 0.0) : std::vector<double>(wetness.begin(), wetness.end());
    if (colorBy == FabricColorBy::Strain) return strain(fabric, state);
    std::vector<double> speeds;
    speeds.reserve(state.v.size());
    for (const Vec3& v : state.v) speeds.push_back(v.norm());
    return speeds;
}

}  // namespace

std::vector<float> wetnessOf(const Fabric& fabric, const FabricState& state, double liquidDensity)
{
    if (std::ranges::all_of(state.absorbed, [](double mass) { return mass == 0.0; })) return {};
    std::vector<float> wetness(fabric.vertexCount(), 0.0f);
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
        const double capacity = poreVolume(fabric, v) * liquidDensity;
        if (capacity > 0.0) wetness[v] = static_cast<float>(std::clamp(state.absorbed[v] / capacity, 0.0, 1.0));
    }
    return wetness;
}

std::vector<double> yarnStrain(const Fabric& fabric, const FabricState& state)
{
    std::vector<double> strain(fabric.vertexCount(), kNone);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const sim::Vec2i& ends = fabric.edges.vertices[e];
        const double stretch = (state.x[ends[1]] - state.x[ends[0]]).norm() / fabric.edges.restLength[e] - 1.0;
        for (const int v : ends) strain[v] = std::max(strain[v], stretch);
    }
    replaceNone(strain);
    return strain;
}

std::vector<double> clothStrain(const Fabric& fabric, const FabricState& state)
{
    std::vector<double> strain(fabric.vertexCount(), kNone);
    for (const Vec3i& face : fabric.faces.vertices) {
        const double stretch = largestStretch(fabric.rest, state.x, face) - 1.0;
        for (const int v : face) strain[v] = std::max(strain[v], stretch);
    }
    replaceNone(strain);
    return strain;
}

void takeYarns(const Fabric& fabric, const FabricState& state, double liquidDensity, FabricColorBy colorBy, FrameSnapshot::Yarns& out)
{
    for (auto* positions : {&out.positions, &out.directions}) positions->clear();
    for (auto* numbers : {&out.along, &out.values, &out.wetness}) numbers->clear();
    for (auto* numbers : {&out.begin, &out.materials}) numbers->clear();
    out.halfAxes.clear();
    const Fabric::Strands& strands = fabric.strands;
    if (strands.count() == 0) return;

    const std::vector<float> wetness = wetnessOf(fabric, state, liquidDensity);
    const std::vector<double> values = vertexValues(colorBy, fabric, state, wetness, yarnStrain);
    out.begin = strands.begin;
    out.materials = strands.material;
    for (int s = 0; s < strands.count(); ++s) {
        out.halfAxes.push_back({static_cast<float>(strands.radius[s][0]), static_cast<float>(strands.radius[s][1])});
        double along = 0.0;
        for (int j = 0; j < strands.size(s); ++j) {
            const int v = strands.vertex(s, j);
            if (j > 0) along += fabric.edges.restLength[strands.edgeBegin(s) + j - 1];
            out.positions.push_back(state.x[v].cast<float>());
            out.directions.push_back(directionAt(fabric, state, s, j).cast<float>());
            out.along.push_back(static_cast<float>(along));
            if (!values.empty()) out.values.push_back(static_cast<float>(values[v]));
            if (!wetness.empty()) out.wetness.push_back(wetness[v]);
        }
    }
}

void takeCloth(const Fabric& fabric, const FabricState& state, double liquidDensity, FabricColorBy colorBy, FrameSnapshot::Cloth& out)
{
    out.positions.clear();
    out.values.clear();
    out.wetness.clear();
    out.triangles = fabric.faces.vertices;
    const std::size_t count = fabric.faces.size() > 0 ? fabric.vertexCount() : 0;
    out.thickness.assign(count, 0.0f);
    out.materials.assign(count, 0);
    if (count == 0) return;

    out.wetness = wetnessOf(fabric, state, liquidDensity);
    for (const Vec3& x : state.x) out.positions.push_back(x.cast<float>());
    for (const double value : vertexValues(colorBy, fabric, state, out.wetness, clothStrain)) out.values.push_back(static_cast<float>(value));
    for (std::size_t f = 0; f < fabric.faces.size(); ++f)
        for (const int v : fabric.faces.vertices[f]) {
            out.thickness[v] = std::max(out.thickness[v], static_cast<float>(fabric.faces.thickness[f]));
            out.materials[v] = fabric.faces.material[f];
        }
}

}  // namespace app
