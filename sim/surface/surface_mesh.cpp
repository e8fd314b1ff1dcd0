#include "sim/surface/surface_mesh.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

namespace sim {

double enclosedVolume(const SurfaceMesh& mesh)
{
    if (mesh.positions.empty()) return 0.0;
    const Vec3 base = mesh.positions.front();  // near the mesh: little is lost to rounding
    return parallelSum(mesh.triangles.size(),
                       [&](std::size_t t) {
                           const Vec3i& corner = mesh.triangles[t];
                           const Vec3 &a = mesh.positions[corner[0]], &b = mesh.positions[corner[1]], &c = mesh.positions[corner[2]];
                           return ((a - base) + (b - base) + (c - base)).dot((b - a).cross(c - a));
                       }) /
           18.0;
}

double surfaceArea(const SurfaceMesh& mesh)
{
    return parallelSum(mesh.triangles.size(), [&](std::size_t t) {
        const Vec3i& corner = mesh.triangles[t];
        const Vec3 &a = mesh.positions[corner[0]], &b = mesh.positions[corner[1]], &c = mesh.positions[corner[2]];
        return 0.5 * (b - a).cross(c - a).norm();
    });
}

}  // namespace sim
