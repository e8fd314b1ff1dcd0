#pragma once

#include "sim/liquid/liquid_grid.h"

namespace sim {

/// u = momentum / mass on faces with mass, 0 elsewhere; marks those faces wet and adds dt g to them. For FLIP the velocities before
/// gravity are kept.
void divideAndAddGravity(const BlockGrid& grid, const Vec3& gravity, double dt, bool flip, LiquidGrid& liquid);

}  // namespace sim
