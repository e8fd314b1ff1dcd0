#pragma once

#include "sim/liquid/liquid_grid.h"

namespace sim {

/// u = momentum / mass on faces with mass, 0 elsewhere; marks those faces wet and adds dt g to them. Keeps the velocities before
/// gravity if asked to.
void computeFaceVelocities(const BlockGrid& grid, const Vec3& gravity, double dt, bool keepsAdvected, LiquidGrid& liquid);

}  // namespace sim
