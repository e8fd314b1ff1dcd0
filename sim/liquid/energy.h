#pragma once

#include "sim/grid/block_grid.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"
#include "sim/step_report.h"

namespace sim {

/// Potential energy −m g·x of all particles [erg], and their mass [g].
struct WeightSums {
    double potential, mass;
};
WeightSums weightSums(const LiquidParticles& particles, const Vec3& gravity);

/// What weight does to particles that go on with their velocities for `duration` [s]: [erg].
double weightWork(const LiquidParticles& particles, const Vec3& gravity, double duration);

/// All energies of the liquid at the present positions, from the modes in the particles' own rows (liquid/README.md, Energy). The step itself
/// takes kinetic and modal energy from G2P, where they cost nothing; this is for the initial state and for tests.
/// @param order  of particles whose modes are not sorted yet; else null
Energies liquidEnergies(const LiquidParticles& particles, const BlockGrid& grid, const Vec3& gravity, const ParticleOrder* order = nullptr);

}  // namespace sim
