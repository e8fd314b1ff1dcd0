#pragma once

#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

struct RelaxScratch {
    std::array<AlignedArray<float>, kAxes> local;
};

/// Displacements that push crowded particles apart (after Ando et al. 2011; particles/README.md, Relaxation):
/// min(1, rate × interval) Σ_j max(0, (1 − d²/reach²)³) reach (x_i − x_j)/d, from the sorted positions. It is the drift of an ordinary
/// differential equation, evaluated like the velocity at the beginning of the step; G2P adds it to the positions.
/// @param reach     distance at which the push ends [cm], at most dx
/// @param interval  time since the last displacements [s]
void relaxationDisplacements(const SortedParticles& sorted, double rate, double reach, double interval, RelaxScratch& scratch,
                             std::array<AlignedArray<double>, kAxes>& displacement);

}  // namespace sim
