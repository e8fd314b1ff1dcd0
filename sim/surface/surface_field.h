#pragma once

#include "sim/surface/surface_particles.h"

namespace sim {

/// How deep the nodes of a grid lie in the liquid of particles [cells]: reach − φ, where φ is the distance from the
/// surface after Zhu & Bridson 2005, the distance from the weighted mean of the particles' places around less that of
/// their radii. It is 0 from where no particle is in reach, so that absent blocks hold the truth; the surface is where
/// it equals the reach.
///
/// The mean of far particles lies in the empty middle between them, where there is no liquid: unlike there, the
/// particles' weights must add up to what a single one has at its radius.
///
/// One task per block, particles in their order: the same bits for any number of threads.
/// @param reach  beyond which particles have no weight [cells], ≤ 7
void surfaceField(const BlockGrid& grid, const SurfaceParticles& particles, float reach, BlockArray<float>& depth);

}  // namespace sim
