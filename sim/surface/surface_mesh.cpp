#include "sim/surface/surface_mesh.h"

#include "sim/core/parallel.h"

#include <Eigen/Geometry>

namespace sim {

double enclosedVolume(const SurfaceMesh& mesh)
{
    if (mesh.positions.empty()) return 0.0;
    const Vec3 apex = mesh.positions.front();  // near the mesh: little is lost to rounding
    return parallelSum(mesh.triangles.size(),
                       [&](std::size_t t) {
                           const Vec3i& corner = mesh.triangles[t];
                           const Vec3 a = mesh.positions[corner[0]] - apex, b = mesh.positions[corner[1]] - apex,
                                      c = mesh.positions[corner[2]] - apex;
                           return a.dot(b.cross(c));
                       }) /
           6.0;
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
