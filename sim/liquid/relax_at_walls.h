#pragma once

#include "sim/grid/cut_grid.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// Make displacements of the relaxation ones that walls leave as they are and that lift no weight. What a wall would cut off lifts all the
/// rest: of a film on a floor the upper particles are pushed up, and the lower ones stay. A displacement ends at the surface that is
/// nearest; then, if Σ m g·d < 0, the same share of each that goes up is left out, so that the sum is 0.
/// @param farthest      how far a displacement may go [cm]
/// @param displacement  of each particle, sorted [cm]
void keepRelaxationFromLifting(const ParticleOrder& order, const CutGrid& cut, const Vec3& gravity, double farthest, const LiquidParticles& particles,
                               std::array<AlignedArray<double>, kAxes>& displacement);

}  // namespace sim
