#pragma once

#include "sim/core/chunk_sums.h"
#include "sim/forces.h"
#include "sim/grid/cut_grid.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// As far in front of the surface [cells]: in a wall that mirrors the liquid the velocity towards it is 0, and what was
/// put right there, under a lid, would never fall while the velocities around it grow.
inline constexpr double kPushedInFront = 0.01;

/// What keeping particles outside of solids did to them.
struct PushOutTotals {
    double lost = 0.0;            ///< kinetic energy to the contacts [erg], negative where moving solids gave some
    double work = 0.0;            ///< work of the impulses of moving solids [erg]
    Vec3 carried = Vec3::Zero();  ///< mass times displacement by moving solids [g cm]

    PushOutTotals operator+(const PushOutTotals& other) const { return {lost + other.lost, work + other.work, carried + other.carried}; }
};

/// Keep particles outside of the obstacles at their final positions. The path of each, straight from where it was before the step, is swept
/// against the solids as they move: where it meets one the particle goes on along the surface, so that no wall is too thin or too
/// fast to hold it. One that began inside a solid is moved out along the gradient of the distance. What touches loses its
/// velocity towards the solid: the contact is inelastic.
/// @param order      the order of the positions before they moved
/// @param before     those positions, in that order; null: particles inside solids are moved out, paths are not looked at
/// @param farthest   how far a particle can have moved since the sort [cm]
/// @param onSolids   what each solid gets of the particles' momentum; begun anew
PushOutTotals pushOutOfObstacles(const ParticleOrder& order, const CutGrid& cut, double farthest,
                                 const std::array<AlignedArray<double>, kAxes>* before, LiquidParticles& particles, ChunkSums<Impulse>& onSolids);

}  // namespace sim
