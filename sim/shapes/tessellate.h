#pragma once

#include "sim/shapes/shape.h"
#include "sim/shapes/triangle_mesh.h"

namespace sim {

/// The surface of a bounded shape as a closed mesh, for pictures: of a box its 12 triangles, else by marching
/// tetrahedra on a lattice of pitch `cell` (sharp edges are cut off by up to a cell). For an inverted shape, ask for
/// its inverted() one: an unbounded shape, or one that takes more than 2e8 cells, throws InputError. An empty shape
/// gives an empty mesh.
TriangleMesh tessellate(const Shape& shape, double cell);

}  // namespace sim
