#pragma once

#include "sim/core/random.h"
#include "sim/shapes/tessellate.h"

namespace sim::test {

inline Vec3 somePoint(std::uint64_t index, double half)
{
    const CounterRandom random(3, 0);
    return half * Vec3(2.0 * random.uniform(index, 0) - 1.0, 2.0 * random.uniform(index, 1) - 1.0, 2.0 * random.uniform(index, 2) - 1.0);
}

/// [cm^2]
inline double area(const TriangleMesh& mesh)
{
    double sum = 0.0;
    for (const Vec3i& t : mesh.triangles)
        sum += 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    return sum;
}

/// Of radius 1 cm around the origin.
inline TriangleMesh ballMesh() { return tessellate(Shape::ball(Vec3::Zero(), 1.0), 0.08); }

}  // namespace sim::test
