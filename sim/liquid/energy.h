#pragma once

#include "sim/grid/block_grid.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// Potential energy −m g·x of all particles [erg], and their mass [g].
struct WeightSums {
    double potential, mass;
};
WeightSums weightSums(const Particles& particles, const Vec3& gravity);

/// What weight does to particles that go on with their velocities for `duration` [s]: [erg].
double weightWork(const Particles& particles, const Vec3& gravity, double duration);

/// Energies of the liquid (liquid/README.md, Energy) [erg].
struct LiquidEnergies {
    double kinetic = 0.0;    ///< energy of the particles' velocities, ½ m v²
    double modal = 0.0;      ///< energy of the higher modes around them
    double potential = 0.0;  ///< −m g·x
    double strain = 0.0;     ///< energy of stretching, where the pressure takes it for no inertia (storeStrain); not in the total
    double total() const { return kinetic + modal + potential; }
    /// Stores the energy of stretching beside the total, with a surface of second order: the pressure neither counts nor keeps it (strainEnergy).
    void storeStrain(double energy)
    {
        modal -= energy;
        strain = energy;
    }
};

/// All energies of the liquid at the present positions, from the modes in the particles' own rows (liquid/README.md, Energy). The step itself
/// takes kinetic and modal energy from G2P, where they cost nothing; this is for the initial state and for tests.
/// @param order  of particles whose modes are not sorted yet; else null
LiquidEnergies liquidEnergies(const Particles& particles, const BlockGrid& grid, const Vec3& gravity, const ParticleOrder* order = nullptr);

/// The part of their modal energy that stretching has, Σ ½ m α² |e|² with the symmetric part e of each particle's velocity gradient and the variance
/// α² = dx²/4 of the B-spline: what the strain correction takes for no inertia (liquid/README.md, Surface of second order) [erg].
double strainEnergy(const Particles& particles, const BlockGrid& grid, const ParticleOrder* order = nullptr);

}  // namespace sim
