#pragma once

#include "sim/surface/surface_particles.h"

namespace sim {

/// How deep the nodes of a grid lie in the liquid of particles: reach − φ, or 0 where that is less, with φ the distance
/// from its surface, negative inside [cells]. So the field is 0 from where no particle is in reach, as it is in blocks
/// that do not exist, and the surface is where it equals the reach.
///
/// φ is the distance from the mean place of the particles in reach less their mean radius, with the weights
/// (1 − d²/reach²)³ (Zhu & Bridson 2005): smooth on bulk liquid, and a ball for a particle alone. Between drops the
/// mean place is amid nothing; there, where particles are much fewer than in bulk liquid, the distance is at least that
/// from the nearest particle, as a sum of sharp weights tells it smoothly.
///
/// Amid bulk liquid, two bins and more below the surface, it is not computed, but taken for as deep as it gets.
///
/// Each block adds up the particles around it in their order: the same bits for any number of threads.
/// @param reach    beyond which particles have no weight [cells], ≤ 7
/// @param spacing  of the particles of bulk liquid [cells]
void surfaceField(const BlockGrid& grid, const SurfaceParticles& particles, float reach, float spacing, BlockArray<float>& depth);

/// Passes of (1 2 1)/4 along each axis over a field that is 0 outside of the blocks; each adds half a cell² to the
/// variance.
void smoothField(const BlockGrid& grid, int passes, BlockArray<float>& values, BlockArray<float>& scratch);

}  // namespace sim
