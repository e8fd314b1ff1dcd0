#pragma once

#include "sim/grid/obstacles.h"

namespace sim {

/// How much of the quadratic B-spline of each lower face of a block lies outside the solids, from the open volume of
/// the parts of cells around (each is cut by the plane whose distance from its middle is the obstacle's).
/// @param mirrors  what is behind a plane wall in a plane of faces is the mirror image of what is in front
/// @param room     out: 512 values [-] for each axis, one axis after another
void roomOfFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, bool mirrors, double* room);

}  // namespace sim
