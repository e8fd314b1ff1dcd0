#pragma once

#include "sim/surface/contour.h"
#include "sim/surface/surface_particles.h"

namespace sim {

/// Velocities of the liquid at the crossings, from the particles in reach by moving least squares: at each the velocity
/// that is affine in space and fits them best, with weights (1 − d²/reach²)³. So they are exact for a body in
/// translation, and for one that turns or is strained off by no more than 4 % of what the velocity changes over a
/// spacing - but where the particles around lie in a plane or line, or alone, they say nothing of how it changes away
/// from it, and the velocity in the plane, on the line or of the particle holds.
/// @param reach  [cells]; velocities of places without particles in reach are 0
void surfaceVelocities(const BlockGrid& grid, const SurfaceParticles& particles, float reach, const std::vector<Crossing>& crossings,
                       std::vector<Vec3>& velocities);

}  // namespace sim
