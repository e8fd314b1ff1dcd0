#pragma once

#include "sim/liquid/viscous_system.h"

#include <array>
#include <vector>

namespace sim {

/// The coarse block that holds a block of half its edge.
inline Vec3i parentBlock(const Vec3i& coords)
{
    return coords.unaryExpr([](int v) { return v >> 1; });
}

/// From one level of a ViscousMultigrid to the next coarser one and back, over the same blocks. Velocities of coarse
/// faces are interpolated linearly to the fine ones; residuals go the other way by the transpose.
class ViscousTransfer {
 public:
    /// Which blocks of the two grids belong together.
    void connect(const BlockGrid& fine, const BlockGrid& coarse);

    /// The coarse system, by the energies of interpolated velocities.
    /// @param scratch  of the fine grid
    void coarsen(const BlockGrid& fineGrid, const ViscousSystem& fine, BlockArray<double, 3>& scratch, const BlockGrid& coarseGrid,
                 ViscousSystem& coarse) const;
    /// rhs of the coarse unknowns, 0 elsewhere.
    void restrict(const BlockArray<double, 3>& residual, const ViscousSystem& coarse, BlockArray<double, 3>& rhs) const;
    /// Add the interpolated velocities to those of the fine unknowns.
    void prolong(const BlockGrid& coarseGrid, const BlockArray<double, 3>& coarse, const BlockGrid& fineGrid, const ViscousSystem& fine,
                 BlockArray<double, 3>& velocity) const;

 private:
    std::vector<int> parent_;                 ///< coarse block of each fine one
    std::vector<std::array<int, 64>> below_;  ///< fine blocks at −1 … 2 along each axis from a coarse block's first
};

}  // namespace sim
