#include "app/export/export_frame.h"

#include "app/frames/snapshot_fabric.h"
#include "sim/core/parallel.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

using sim::Vec3;

constexpr std::size_t kGrain = 4096;

ExportArray floats(const char* name, const char* unit, std::size_t points, int components = 1)
{
    return {name, unit, components, std::vector<float>(points * components)};
}

ExportArray integers(const char* name, std::size_t points) { return {name, "", 1, std::vector<std::uint32_t>(points)}; }

float* floatsOf(ExportArray& array) { return std::get<std::vector<float>>(array.values).data(); }
std::uint32_t* integersOf(ExportArray& array) { return std::get<std::vector<std::uint32_t>>(array.values).data(); }

ExportPart emptyPart(std::string name, ExportPart::Kind kind)
{
    ExportPart part;
    part.name = std::move(name);
    part.kind = kind;
    return part;
}

void put(const Vec3& vector, std::size_t point, float* out) { Eigen::Map<Eigen::Vector3f>(out + 3 * point) = vector.cast<float>(); }

/// Numbers of the particles in the order of their ids.
std::vector<std::uint32_t> inOrderOfId(const sim::LiquidParticles& liquid)
{
    std::vector<std::uint64_t> keys(liquid.count);
    for (std::size_t p = 0; p < liquid.count; ++p) keys[p] = std::uint64_t{liquid.id[p]} << 32 | p;
    std::ranges::sort(keys);
    std::vector<std::uint32_t> order(keys.begin(), keys.end());  // the lower half of each key
    return order;
}

/// Is there liquid, or may some come from a source or out of the fabric?
bool mayHaveLiquid(const sim::State& state)
{
    return state.liquid.count > 0 || state.nextId > 0 || !state.emittedVolume.empty() ||
           std::ranges::any_of(state.fabric.absorbed, [](double mass) { return mass > 0.0; });
}

ExportPart liquidPart(const sim::LiquidParticles& liquid, double density)
{
    const std::size_t n = liquid.count;
    ExportPart part = emptyPart("liquid", ExportPart::Kind::Points);
    part.positions.resize(n);
    part.arrays = {floats("velocity", "cm/s", n, 3), floats("speed", "cm/s", n), floats("volume", "cm^3", n), integers("id", n)};
    float *velocity = floatsOf(part.arrays[0]), *speed = floatsOf(part.arrays[1]), *volume = floatsOf(part.arrays[2]);
    std::uint32_t* id = integersOf(part.arrays[3]);
    const std::vector<std::uint32_t> order = inOrderOfId(liquid);
    sim::parallelFor(n, kGrain, [&](std::size_t i) {
        const std::size_t p = order[i];
        const Vec3 v = liquid.velocity(p);
        part.positions[i] = liquid.position(p).cast<float>();
        put(v, i, velocity);
        speed[i] = static_cast<float>(v.norm());
        volume[i] = static_cast<float>(liquid.mass[p] / density);
        id[i] = liquid.id[p];
    });
    return part;
}

ExportPart surfacePart(const sim::SurfaceMesh& surface)
{
    const std::size_t n = surface.positions.size();
    ExportPart part = emptyPart("surface", ExportPart::Kind::Triangles);
    part.positions.resize(n);
    part.arrays = {floats("velocity", "cm/s", n, 3), floats("normal", "", n, 3)};
    for (std::size_t i = 0; i < n; ++i) {
        part.positions[i] = surface.positions[i].cast<float>();
        put(surface.velocities[i], i, floatsOf(part.arrays[0]));
        put(surface.normals[i], i, floatsOf(part.arrays[1]));
    }
    for (const sim::Vec3i& triangle : surface.triangles) part.triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
    return part;
}

/// Where the vertices of a part of the fabric are, how fast and how wet.
/// @param vertices    of the fabric, one for each point of the part
/// @param saturation  of each vertex of the fabric; empty: all is dry
void addFabricPoints(std::span<const int> vertices, const sim::FabricState& state, std::span<const float> saturation, ExportPart& part)
{
    const std::size_t n = vertices.size();
    ExportArray velocity = floats("velocity", "cm/s", n, 3), wet = floats("saturation", "", n);
    ExportArray absorbed = floats("absorbed", "g", n);
    part.positions.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const int v = vertices[i];
        part.positions[i] = state.x[v].cast<float>();
        put(state.v[v], i, floatsOf(velocity));
        if (!saturation.empty()) floatsOf(wet)[i] = saturation[v];
        floatsOf(absorbed)[i] = static_cast<float>(state.absorbed[v]);
    }
    for (ExportArray* array : {&velocity, &wet, &absorbed}) part.arrays.push_back(std::move(*array));
}

ExportPart yarnPart(const sim::Fabric& fabric, const sim::FabricState& state, std::span<const float> saturation)
{
    const sim::Fabric::Strands& strands = fabric.strands;
    ExportPart part = emptyPart("yarns", ExportPart::Kind::Lines);
    part.begin = strands.begin;
    addFabricPoints(strands.vertices, state, saturation, part);
    ExportArray radius = floats("radius", "cm", strands.vertices.size());
    ExportArray material = integers("material", strands.vertices.size());
    for (int s = 0; s < strands.count(); ++s)
        for (int i = strands.begin[s]; i < strands.begin[s + 1]; ++i) {
            // Of a flat yarn: of a round one with the same section.
            floatsOf(radius)[i] = static_cast<float>(std::sqrt(strands.radius[s][0] * strands.radius[s][1]));
            integersOf(material)[i] = static_cast<std::uint32_t>(strands.material[s]);
        }
    part.arrays.push_back(std::move(radius));
    part.arrays.push_back(std::move(material));
    return part;
}

/// Unit normals of vertices: of the triangles around, each by its area. Where they cancel, or there are none, along z.
ExportArray vertexNormals(const std::vector<Eigen::Vector3f>& positions, const std::vector<Eigen::Vector3i>& triangles)
{
    std::vector<Vec3> sums(positions.size(), Vec3::Zero());
    for (const Eigen::Vector3i& t : triangles) {
        const Vec3 a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(), c = positions[t[2]].cast<double>();
        for (const int corner : t) sums[corner] += (b - a).cross(c - a);
    }
    ExportArray normal = floats("normal", "", positions.size(), 3);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = sums[i].norm();
        put(length > 0.0 ? Vec3(sums[i] / length) : Vec3::UnitZ(), i, floatsOf(normal));
    }
    return normal;
}

/// Part of the cloth, with the vertices that faces have: those of yarns are elsewhere.
ExportPart clothPart(const sim::Fabric& fabric, const sim::FabricState& state, std::span<const float> saturation)
{
    ExportPart part = emptyPart("cloth", ExportPart::Kind::Triangles);
    std::vector<int> point(fabric.vertexCount(), -1), vertices;
    for (const sim::Vec3i& face : fabric.faces.vertices)
        for (const int v : face) point[v] = 0;
    for (std::size_t v = 0; v < point.size(); ++v)
        if (point[v] == 0) {
            point[v] = static_cast<int>(vertices.size());
            vertices.push_back(static_cast<int>(v));
        }
    addFabricPoints(vertices, state, saturation, part);
    ExportArray material = integers("material", vertices.size());
    for (std::size_t f = 0; f < fabric.faces.size(); ++f) {
        const sim::Vec3i& face = fabric.faces.vertices[f];
        part.triangles.emplace_back(point[face[0]], point[face[1]], point[face[2]]);
        for (const int corner : part.triangles.back()) integersOf(material)[corner] = static_cast<std::uint32_t>(fabric.faces.material[f]);
    }
    part.arrays.push_back(vertexNormals(part.positions, part.triangles));
    part.arrays.push_back(std::move(material));
    return part;
}

/// "obstacle_" and the obstacle's name in letters that every format takes, or a number where that is taken.
std::string freeName(const std::string& obstacle, const std::vector<ExportPart>& parts)
{
    std::string name = "obstacle_";
    for (const char c : obstacle) {
        const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        name += isPlain ? c : '_';
    }
    const auto isTaken = [&](const std::string& wanted) { return std::ranges::count(parts, wanted, &ExportPart::name) > 0; };
    std::string result = name;
    for (int n = 2; isTaken(result); ++n) result = fmt::format("{}_{}", name, n);
    return result;
}

ExportPart obstaclePart(const FrameSnapshot::Mesh& obstacle, std::string name)
{
    ExportPart part = emptyPart(std::move(name), ExportPart::Kind::Triangles);
    part.positions = obstacle.positions;
    part.triangles = obstacle.triangles;
    ExportArray velocity = floats("velocity", "cm/s", part.positions.size(), 3);
    for (std::size_t i = 0; i < obstacle.velocities.size(); ++i) put(obstacle.velocities[i].cast<double>(), i, floatsOf(velocity));
    part.arrays.push_back(std::move(velocity));
    return part;
}

}  // namespace

const ExportArray* ExportPart::find(std::string_view array) const
{
    const auto found = std::ranges::find(arrays, array, &ExportArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

std::string unitsOf(const ExportPart& part)
{
    std::string units = "lengths in cm";
    for (const ExportArray& array : part.arrays)
        if (!array.unit.empty()) units += fmt::format(", {} in {}", array.name, array.unit);
    return units;
}

ExportFrame exportFrame(std::int64_t number, const sim::State& state, const sim::Fabric& fabric, double density,
                        std::span<const FrameSnapshot::Mesh> obstacles, const sim::SurfaceMesh* surface)
{
    ExportFrame frame{.number = number, .time = state.time, .parts = {}};
    if (mayHaveLiquid(state)) frame.parts.push_back(liquidPart(state.liquid, density));
    if (surface) frame.parts.push_back(surfacePart(*surface));
    const std::vector<float> saturation = wetnessOf(fabric, state.fabric, density);
    if (fabric.strands.count() > 0) frame.parts.push_back(yarnPart(fabric, state.fabric, saturation));
    if (fabric.faces.size() > 0) frame.parts.push_back(clothPart(fabric, state.fabric, saturation));
    for (const FrameSnapshot::Mesh& obstacle : obstacles) frame.parts.push_back(obstaclePart(obstacle, freeName(obstacle.name, frame.parts)));
    return frame;
}

}  // namespace app
