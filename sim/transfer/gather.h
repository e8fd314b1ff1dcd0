#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

#include <vector>

namespace sim {

/// What one G2P does beside gathering the modes.
struct GatherSettings {
    double dt = 0.0;         ///< positions move with the gathered velocity for this long [s]
    int modes = 8;           ///< N_r
    double keep = 1.0;       ///< factor on every mode but the mean [-]
    double flipRatio = 0.0;  ///< R of FLIP; read with flipVelocity only [-]

    /// FLIP: the face velocities straight after P2G, before any force; else null.
    const BlockArray<double, 3>* flipVelocity = nullptr;
    /// Velocities of the faces whose modes the particles get, where these are the reflected ones; else null.
    const BlockArray<double, 3>* reflected = nullptr;
    /// Cells whose particles move by the midpoint rule, with the velocity, not reflected, that they will find where it takes them in half the step;
    /// others move with the velocity that they get. Null if none do.
    const BlockBits<>* atMidpoint = nullptr;
    /// Velocities of the frames in which particles of each block move by the midpoint rule [cm/s]; null where all rest.
    const Vec3* frames = nullptr;
    /// Displacements of the particles to add to the positions [cm], one array per axis; null where there are none.
    const AlignedArray<double>* displacement = nullptr;
    /// Displacements on the faces [cm], interpolated at the old positions and added to the new ones; null where there are none.
    const BlockArray<double, 3>* faceDisplacement = nullptr;
    /// Cells whose particles gather all N_r modes, those of others no more than kModesAtSurface; null if all do.
    const BlockBits<>* manyModes = nullptr;
};

/// N_r of particles at the surface. Quadratic modes are fitted to second differences that don't see the weights: where a stencil
/// reaches out of the liquid, faces that carry next to nothing would set them. With them there, noise in liquid at rest grows four (11 modes)
/// to seven times (27) as far, and a dam break with 27 modes has more energy than it began with. Four modes there would be calmer still,
/// but lose more energy than eight everywhere (tests/bench/results/mode_stability.md).
inline constexpr int kModesAtSurface = 8;

/// Sums that fall out of G2P, per block: momentum [g cm/s], kinetic and modal energy, and of the latter what stretching has (strainEnergy) [erg],
/// and the largest squared speeds [cm²/s²].
struct GatherSums {
    Vec3 momentum = Vec3::Zero();
    double kinetic = 0.0, modal = 0.0, strain = 0.0, maxSpeedSquared = 0.0;
    double maxPathSquared = 0.0;  ///< largest squared speed along the particles' paths, where any move by the midpoint rule; else 0
};

struct GatherScratch {
    std::vector<GatherSums> perBlock;
    std::array<AlignedArray<double>, kAxes> oldVelocity;  ///< FLIP: v_p in the sorted order
};

/// G2P: gather the modes of every particle into its own row and move it (transfer/README.md, Grid to particles). Same as
/// facesToParticlesReference to round-off. Lanes = particles of one cell (transfer/README.md, Kernels).
/// @return the sums over all particles, in the order of the blocks
GatherSums facesToParticles(const FaceFields& faces, const ParticleOrder& order, const BlockGrid& grid, const GatherSettings& settings,
                            GatherScratch& scratch, Particles& particles);

}  // namespace sim
