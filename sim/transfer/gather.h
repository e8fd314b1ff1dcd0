#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"
#include "sim/step_report.h"

#include <vector>

namespace sim {

/// What one G2P does beside gathering the modes.
struct GatherSettings {
    double dt = 0.0;        ///< positions move with the gathered velocity for this long [s]
    int modes = 8;          ///< N_r
    double keep = 1.0;      ///< factor on every mode but the mean [-]
    double flipRatio = 0.0; ///< R of FLIP; read with flipVelocity only [-]

    /// FLIP: the face velocities straight after P2G, before any force; else null.
    const BlockArray<double, 3>* flipVelocity = nullptr;
    /// Displacements to add to the positions [cm], one array per axis; null where there are none (relaxation is off).
    const AlignedArray<double>* displacement = nullptr;
    /// Cells whose particles meet faces without a velocity (extrapolate.h); null where all faces are valid.
    const BlockBits<>* gaps = nullptr;
};

/// Sums that fall out of G2P, per block: kinetic and modal energy [erg] and the largest squared speed [cm²/s²].
struct GatherSums {
    double kinetic = 0.0, modal = 0.0, maxSpeedSquared = 0.0;
};

struct GatherScratch {
    std::vector<GatherSums> perBlock;
    std::array<AlignedArray<double>, kAxes> oldVelocity;  ///< FLIP: v_p in the sorted order
};

/// G2P: gather the modes of every particle into its own row and move it (model-fluid 4, 10). Same as
/// facesToParticlesReference to round-off. Lanes = particles of one cell (kernel-design 6).
/// @return the sums over all particles, in the order of the blocks
GatherSums facesToParticles(const FaceFields& faces, const ParticleOrder& order, const BlockGrid& grid, const GatherSettings& settings,
                            GatherScratch& scratch, LiquidParticles& particles);

/// G2P of one particle where some faces of its stencils have no velocity: per component a least-squares fit of mean and gradient
/// over the faces that have, or their mean if they are too few (model-fluid 4.8). Returns monomial modes.
std::array<std::array<double, 4>, kAxes> gatherWithGaps(const FaceFields& faces, const BlockArray<double, 3>& velocity, const BlockGrid& grid,
                                                        const Vec3& x, int modes);

}  // namespace sim
