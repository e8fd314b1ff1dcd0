#pragma once

#include "sim/core/types.h"

#include <vector>

namespace sim {

/// Triangles with shared corners; counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> vertices;    ///< [cm]
    std::vector<Vec3i> triangles;  ///< indices into vertices
};

}  // namespace sim
