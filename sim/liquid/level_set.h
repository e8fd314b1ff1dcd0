#pragma once

#include "sim/liquid/liquid_grid.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// Radius of the ball of liquid around each particle, in cells: a little more than half a cell's diagonal, so that a particle
/// always makes its own cell liquid (model-fluid 5.6).
inline constexpr double kLiquidRadius = 0.8836;

/// Signed distance to the union of balls around the particles, at the cell middles (model-fluid 5.6): exact where the nearest
/// particle is within the 3³ cells around. Beside a liquid cell it is at most that cell's value plus dx, as a distance must be; further
/// away it is positive and large.
void levelSetFromParticles(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, LiquidGrid& liquid);

/// Which cells have a pressure: those where the level set is negative and some face is open, and cells whose middle is in an obstacle, so
/// that no particle may come near enough, if they touch liquid through an open face and their neighbour on the way out is liquid: they
/// continue the liquid into the wall (Batty 2007), not up along it. All others get a positive level set.
/// @param full  the liquid fills a closed box: every cell with an open face is liquid
void classifyCells(const BlockGrid& grid, const ObstacleField& obstacles, bool full, LiquidGrid& liquid);

}  // namespace sim
