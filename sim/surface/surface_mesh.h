#pragma once

#include "sim/core/types.h"

#include <vector>

namespace sim {

/// A closed surface of triangles that share their vertices: every edge has two triangles, which pass it in opposite
/// directions. Triangles are counter-clockwise seen from outside.
struct SurfaceMesh {
    std::vector<Vec3> positions;   ///< [cm]
    std::vector<Vec3> normals;     ///< out of the liquid, of length 1; one per position
    std::vector<Vec3> velocities;  ///< velocity of the liquid at each position, or none [cm/s]
    std::vector<Vec3i> triangles;
};

/// Volume that the triangles enclose, after the divergence theorem: exact for the mesh [cm^3].
double enclosedVolume(const SurfaceMesh& mesh);

/// [cm^2]
double surfaceArea(const SurfaceMesh& mesh);

}  // namespace sim
