#pragma once

#include "sim/liquid/viscous_transfer.h"

namespace sim {

/// Approximate inverse of a ViscousSystem, symmetric and positive definite: one V-cycle. Keeps its grids while the
/// blocks stay the same; nothing is allocated then.
///
/// Coarse cells are 2³ cells each. Velocities go down linearly, so that rigid motions, which cost the conjugate
/// gradients most in threads and sheets, are the same on all levels; strains keep their volume. Smoothed by Chebyshev
/// polynomials of the matrix over its diagonal, the same before and after the coarse correction. There are as many
/// levels as it takes until inertia weighs as much as viscosity.
class ViscousMultigrid {
 public:
    /// @param stiffness  dt μ / (ρ dx²) of the liquid [-]; the system must stay as it is while cycles are asked for
    void build(const BlockGrid& grid, const ViscousSystem& system, double stiffness);

    /// solution() = cycle applied to the residual, which is 0 where nothing is unknown.
    void cycle(const BlockArray<double, 3>& residual) { cycle(0, residual); }
    const BlockArray<double, 3>& solution() const { return levels_[0].solution; }

 private:
    struct Level {
        const BlockGrid* grid = nullptr;
        const ViscousSystem* system = nullptr;
        BlockArray<double, 3> solution, residual, direction, applied;
        ViscousTransfer toCoarser;

        // Of the coarser levels only; the finest one's are those of the liquid.
        BlockGrid ownGrid;
        ViscousSystem ownSystem;
        BlockArray<double, 3> rhs;
    };

    void buildShape(const BlockGrid& grid);
    void point(const BlockGrid& grid);
    void cycle(int level, const BlockArray<double, 3>& rhs);
    void smooth(Level& level, const BlockArray<double, 3>& rhs, double lowest, int steps, bool fromZero);

    std::vector<Level> levels_;  ///< down to a single block; those in use are the first count_
    std::vector<Vec3i> coords_;  ///< coordinates of the finest level's blocks: tell whether the shape still fits
    int count_ = 0;
    double stiffness_ = 0.0;
};

}  // namespace sim
