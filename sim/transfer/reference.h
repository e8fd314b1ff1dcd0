#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"
#include "sim/particles/velocity_modes.h"

namespace sim {

// The transfers in their plainest form: what the fast kernels of scatter.h and gather.h are compared with.

/// The 3×3×3 faces normal to `axis` that a particle touches.
struct Stencil {
    /// @param x  position [cm]
    Stencil(const BlockGrid& grid, int axis, const Vec3& x);

    Basis basis;
    Vec3i first;  ///< cell coordinates of face (0, 0, 0) of the stencil: the face at the lower side of that cell

    double weight(const Vec3i& node) const { return basis[0].weight[node.x()] * basis[1].weight[node.y()] * basis[2].weight[node.z()]; }
};

/// The face at the lower side of a cell given by global coordinates.
CellRef faceOfCell(const BlockGrid& grid, const Vec3i& cell);

/// P2G: mass and momentum of every face, from sorted particles whose modes stand in the rows order.source tells.
void particlesToFacesReference(const SortedParticles& sorted, FaceFields& faces);

/// G2P: the modes of every particle, in its own row, from the face velocities. All faces are taken as valid.
/// @param modes  N_r, at most the rows that the particles store
void facesToParticlesReference(const FaceFields& faces, const BlockGrid& grid, int modes, Particles& particles);

/// Orthogonal coefficients of one component gathered at a stencil, N_r = modes.
Modes gatherModes(const BlockArray<double, 3>& velocity, const BlockGrid& grid, int axis, const Stencil& stencil, int modes);

}  // namespace sim
