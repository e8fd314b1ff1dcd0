#include "sim/core/check.h"
#include "sim/fabric/fabric.h"
#include "sim/fabric/parallel_transport.h"

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sim {

namespace {

/// Adds one piece behind those that are there.
class PieceAssembly {
 public:
    PieceAssembly(const FabricPiece& piece, Fabric& fabric)
        : piece_(piece), fabric_(fabric), first_(static_cast<int>(fabric.vertexCount())), material_(static_cast<int>(fabric.materials.size()))
    {
    }

    void add()
    {
        addVertices();
        for (const std::vector<int>& strand : piece_.strands) addStrand(strand);
        for (const Vec3i& face : piece_.faces) addFace(face);
        for (std::size_t i = 0; i < piece_.points.size(); ++i) {
            if (!(fabric_.mass[first_ + i] > 0.0))
                fail(fmt::format("vertex {} is on no yarn and no face; remove it", piece_.called(static_cast<int>(i))));
        }
        for (const PinGroup& group : piece_.pins) addPins(group);
    }

 private:
    [[noreturn]] void fail(const std::string& message) const
    {
        const std::string where = piece_.where.empty() ? "" : piece_.where + ": ";
        throw InputError(fmt::format("{}fabrics.{}: {}", where, piece_.name, message));
    }

    double volumeToMass() const { return piece_.material.envelopeDensity(); }

    void addVertices()
    {
        const std::size_t count = fabric_.vertexCount() + piece_.points.size();
        fabric_.materials.push_back(piece_.material);
        fabric_.warp.push_back(piece_.warp);
        fabric_.rest.insert(fabric_.rest.end(), piece_.points.begin(), piece_.points.end());
        fabric_.mass.resize(count, 0.0);
        fabric_.volume.resize(count, 0.0);
        fabric_.radius.resize(count, 0.0);
        fabric_.vertexMaterial.resize(count, material_);
        fabric_.pinned.resize(count, 0);
    }

    /// Number in the whole fabric of a vertex of the piece.
    int global(int vertex) const
    {
        if (vertex < 0 || vertex >= static_cast<int>(piece_.points.size()))
            fail(fmt::format("there is no vertex {}; there are {}", vertex, piece_.points.size()));
        return first_ + vertex;
    }

    /// An element's share of a vertex.
    void addTo(int vertex, double volume, double contactRadius)
    {
        fabric_.volume[vertex] += volume;
        fabric_.mass[vertex] += volume * volumeToMass();
        fabric_.radius[vertex] = std::max(fabric_.radius[vertex], contactRadius);
    }

    void addStrand(const std::vector<int>& strand)
    {
        const int number = fabric_.strands.count();
        if (strand.size() < 2) fail(fmt::format("yarn {} has {} vertices; it needs 2", number, strand.size()));
        for (const int vertex : strand) fabric_.strands.vertices.push_back(global(vertex));
        fabric_.strands.begin.push_back(static_cast<int>(fabric_.strands.vertices.size()));
        fabric_.strands.material.push_back(material_);
        fabric_.strands.radius.push_back(piece_.radius);
        for (std::size_t j = 0; j + 1 < strand.size(); ++j) addEdge(number, strand, j);
    }

    void addEdge(int strandNumber, const std::vector<int>& strand, std::size_t j)
    {
        const Vec2i edge(global(strand[j]), global(strand[j + 1]));
        const Vec3 along = fabric_.rest[edge[1]] - fabric_.rest[edge[0]];
        const double length = along.norm();
        if (!(length > 0.0))
            fail(fmt::format("vertices {} and {} of a yarn are at one place; remove one", piece_.called(strand[j]), piece_.called(strand[j + 1])));
        if (j > 0) {
            const Vec3 before = fabric_.rest[edge[0]] - fabric_.rest[global(strand[j - 1])];
            constexpr double kSharpestTurn = 1.0e-9;  // 1 + cosine; bending energy is infinite at 0
            if (1.0 + before.dot(along) / (before.norm() * length) < kSharpestTurn)
                fail(fmt::format("a yarn turns straight back at vertex {}; make a bend", piece_.called(strand[j])));
        }
        const auto [a, b] = piece_.radius;
        const double volume = kPi * a * b * length;
        fabric_.edges.vertices.push_back(edge);
        fabric_.edges.strand.push_back(strandNumber);
        fabric_.edges.restLength.push_back(length);
        fabric_.edges.twistInertia.push_back(0.25 * volumeToMass() * volume * (a * a + b * b));
        fabric_.edges.twistHeld.push_back(0);
        for (const int vertex : edge) addTo(vertex, 0.5 * volume, std::sqrt(a * b));
    }

    void addFace(const Vec3i& corners)
    {
        const Vec3i face(global(corners[0]), global(corners[1]), global(corners[2]));
        const Vec3 e1 = fabric_.rest[face[1]] - fabric_.rest[face[0]];
        const Vec3 e2 = fabric_.rest[face[2]] - fabric_.rest[face[0]];
        const Vec3 across = e1.cross(e2);
        const double area = 0.5 * across.norm();
        constexpr double kFlattest = 1.0e-9;  // area per square of the edges: the rest is round-off
        if (!(area > kFlattest * (e1.squaredNorm() + e2.squaredNorm())))
            fail(fmt::format("the face {}, {}, {} has no area; remove it", piece_.called(corners[0]), piece_.called(corners[1]),
                             piece_.called(corners[2])));
        constexpr double kSteepest = 1.0e-3;  // of the warp's part in the face
        if (piece_.material.hasWarp() && piece_.warp.cross(across).norm() < kSteepest * across.norm())
            fail(fmt::format("the warp goes through the face {}, {}, {} and not along it; choose another warp", piece_.called(corners[0]),
                             piece_.called(corners[1]), piece_.called(corners[2])));
        const double thickness = piece_.radius[0] + piece_.radius[1];
        fabric_.faces.vertices.push_back(face);
        fabric_.faces.material.push_back(material_);
        fabric_.faces.thickness.push_back(thickness);
        for (const int vertex : face) addTo(vertex, area * thickness / 3.0, 0.5 * thickness);
    }

    void addPins(const PinGroup& group)
    {
        const int motion = static_cast<int>(fabric_.pins.motions.size());
        fabric_.pins.motions.push_back(group.motion);
        std::vector<char> holdsTwist(piece_.points.size(), 0);
        for (const int vertex : group.vertices) {
            const int v = global(vertex);
            holdsTwist[vertex] = group.twist;
            if (fabric_.pinned[v]) continue;  // the first group that names a vertex moves it
            fabric_.pinned[v] = 1;
            fabric_.pins.vertex.push_back(v);
            fabric_.pins.motion.push_back(motion);
        }
        if (!group.twist) return;
        const auto isHeld = [&](int v) { return v >= first_ && holdsTwist[v - first_]; };
        for (std::size_t e = 0; e < fabric_.edges.size(); ++e) {
            const Vec2i& edge = fabric_.edges.vertices[e];
            if (isHeld(edge[0]) || isHeld(edge[1])) fabric_.edges.twistHeld[e] = 1;
        }
    }

    const FabricPiece& piece_;
    Fabric& fabric_;
    int first_, material_;
};

/// Pins in the order of their vertices.
void sortPins(Fabric::Pins& pins)
{
    std::vector<std::pair<int, int>> all;
    for (std::size_t i = 0; i < pins.vertex.size(); ++i) all.emplace_back(pins.vertex[i], pins.motion[i]);
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size(); ++i) std::tie(pins.vertex[i], pins.motion[i]) = all[i];
}

/// The water of a vertex is in its elements by their volumes, and fills the sections of yarns evenly.
void findWetTwist(Fabric& fabric)
{
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) {
        const auto [a, b] = fabric.strands.radius[fabric.edges.strand[e]];
        const double half = 0.5 * kPi * a * b * fabric.edges.restLength[e];
        std::array<double, 2>& perMass = fabric.edges.wetTwist.emplace_back();
        for (int end = 0; end < 2; ++end) perMass[end] = 0.25 * (a * a + b * b) * half / fabric.volume[fabric.edges.vertices[e][end]];
    }
}

/// A unit vector across t: the axis with t's smallest component, made orthogonal to it.
Vec3 anyAcross(const Vec3& t)
{
    Vec3::Index axis = 0;
    t.cwiseAbs().minCoeff(&axis);
    const Vec3 e = Vec3::Unit(axis);
    return (e - e.dot(t) * t).normalized();
}

/// The reference axis u of one edge, for the next: parallel transport (fabric/rods/README.md, Kinematics).
Vec3 carriedAcross(const Vec3& u, const Vec3& from, const Vec3& to)
{
    const Vec3T<double> t = toVec3T(to);
    return toVec3(unitAcross(transported(toVec3T(u), toVec3T(from), t), t));
}

}  // namespace

Fabric assembleFabric(std::span<const FabricPiece> pieces)
{
    Fabric fabric;
    for (const FabricPiece& piece : pieces) PieceAssembly(piece, fabric).add();
    sortPins(fabric.pins);
    findWetTwist(fabric);
    return fabric;
}

FabricState restState(const Fabric& fabric)
{
    FabricState state;
    state.x = fabric.rest;
    state.v.assign(fabric.vertexCount(), Vec3::Zero());
    state.absorbed.assign(fabric.vertexCount(), 0.0);
    state.acceleration.assign(fabric.vertexCount(), Vec3::Zero());
    state.held.assign(fabric.vertexCount(), Vec3::Zero());
    for (int v : fabric.pins.vertex) state.held[v] = Vec3::Ones();
    const std::size_t edges = fabric.edges.size();
    state.theta.assign(edges, 0.0);
    state.omega.assign(edges, 0.0);
    state.referenceTwist.assign(edges, 0.0);
    state.tangent.resize(edges);
    state.reference.resize(edges);
    for (std::size_t e = 0; e < edges; ++e) {
        const Vec2i& edge = fabric.edges.vertices[e];
        state.tangent[e] = (fabric.rest[edge[1]] - fabric.rest[edge[0]]).normalized();
        const bool isFirst = e == 0 || fabric.edges.strand[e] != fabric.edges.strand[e - 1];
        state.reference[e] = isFirst ? anyAcross(state.tangent[e]) : carriedAcross(state.reference[e - 1], state.tangent[e - 1], state.tangent[e]);
    }
    return state;
}

std::vector<double> poreCapacity(const Fabric& fabric, double density)
{
    std::vector<double> capacity;
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) capacity.push_back(poreVolume(fabric, v) * density);
    return capacity;
}

FabricState initialState(const Fabric& fabric, std::span<const FabricPiece> pieces, double liquidDensity)
{
    FabricState state = restState(fabric);
    const std::vector<double> capacity = poreCapacity(fabric, liquidDensity);
    std::size_t v = 0;
    for (const FabricPiece& piece : pieces) {
        for (const std::size_t end = v + piece.points.size(); v < end; ++v) {
            state.v[v] = piece.velocity;
            state.absorbed[v] = piece.wetness * capacity[v];
        }
    }
    for (const int vertex : fabric.pins.vertex) state.v[vertex].setZero();
    return state;
}

}  // namespace sim
