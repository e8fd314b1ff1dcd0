#pragma once

#include "sim/particles/liquid_particles.h"

#include <cstdint>

namespace sim {

/// How particles whose mass has changed are brought back to about the nominal one (model-fluid 5.3).
struct ResampleSettings {
    double nominalMass = 0.0;    ///< what a particle should weigh [g]
    double nominalRadius = 0.0;  ///< r* of model-fluid 5.1 [cm]
    double dx = 0.0;             ///< cell of the grid, the unit of length of the modes [cm]
    int mergeInterval = 8;       ///< a particle looks for somebody to merge with in one of so many steps, at random
    std::uint64_t seed = 1;
};

/// Is there a particle more than a tenth off the nominal mass?
bool needsResampling(const LiquidParticles& particles, double nominalMass);

/// Split particles of more than twice the nominal mass into up to 8 equal ones; let those below half of it go over to
/// their neighbours, and those above it give what they have too much to lighter ones. Splitting comes first; the modes
/// must stand in the particles' own rows, so before the sort. Mass, momentum and centre of mass are kept to round-off;
/// new particles are numbered on from nextId. Serial, for the few particles that it touches; the result depends on ids
/// and positions, never on threads.
void resample(const ResampleSettings& settings, std::int64_t step, LiquidParticles& particles, std::uint32_t& nextId);

}  // namespace sim
