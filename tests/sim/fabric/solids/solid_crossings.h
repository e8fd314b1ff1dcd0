#pragma once

#include "sim/scene/scene.h"
#include "tests/sim/fabric/pieces.h"

#include <algorithm>

// Fabric within solids, found by nothing but the signed distance of points.

namespace sim::testing {

/// Does a solid reach into the hull of some points? The distance of a point changes by no more than it moves; pieces of 1e-4 cm are left.
inline bool reachesInto(const Shape& solid, const std::array<Vec3, 3>& x)
{
    const Vec3 middle = (x[0] + x[1] + x[2]) / 3.0;
    double radius = 0.0;
    for (const Vec3& corner : x) radius = std::max(radius, (corner - middle).norm());
    const double distance = solid.distance(middle);
    if (distance < 0.0) return true;
    if (distance > radius || radius < 1.0e-4) return false;
    int a = 0, b = 1;
    for (const auto& [i, j] : {std::pair(1, 2), std::pair(2, 0)})
        if ((x[i] - x[j]).norm() > (x[a] - x[b]).norm()) a = i, b = j;
    std::array<Vec3, 3> one = x, other = x;
    one[a] = other[b] = 0.5 * (x[a] + x[b]);
    return reachesInto(solid, one) || reachesInto(solid, other);
}

/// Vertices whose ways, and edges and faces that at some of 16 times, reach into a solid, as it sees them, while it moves.
inline int crossings(const Fabric& fabric, const ObstacleSettings& solid, double t0, double t1, std::span<const Vec3> x, std::span<const Vec3> u)
{
    const Eigen::Isometry3d toBegin = solid.motion.transform(t0).inverse(), toEnd = solid.motion.transform(t1).inverse();
    std::vector<Vec3> from(x.size()), to(x.size()), at(x.size());
    int count = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
        from[v] = toBegin * x[v];
        to[v] = toEnd * (x[v] + u[v]);
        count += reachesInto(solid.shape, {from[v], to[v], to[v]});
    }
    constexpr int kTimes = 16;
    for (int n = 1; n <= kTimes; ++n) {
        for (std::size_t v = 0; v < x.size(); ++v) at[v] = from[v] + n / double(kTimes) * (to[v] - from[v]);
        for (const Vec2i& e : fabric.edges.vertices) count += reachesInto(solid.shape, {at[e[0]], at[e[1]], at[e[1]]});
        for (const Vec3i& f : fabric.faces.vertices) count += reachesInto(solid.shape, {at[f[0]], at[f[1]], at[f[2]]});
    }
    return count;
}

/// Least distance of vertices and of the middles of edges and faces from a solid [cm].
inline double clearance(const Fabric& fabric, std::span<const Vec3> x, const Shape& solid)
{
    double least = 1.0e9;
    for (const Vec3& p : x) least = std::min(least, solid.distance(p));
    for (const Vec2i& e : fabric.edges.vertices)
        if (reachesInto(solid, {x[e[0]], x[e[1]], x[e[1]]})) least = std::min(least, 0.0);
    for (const Vec3i& f : fabric.faces.vertices)
        if (reachesInto(solid, {x[f[0]], x[f[1]], x[f[2]]})) least = std::min(least, 0.0);
    return least;
}

}  // namespace sim::testing
