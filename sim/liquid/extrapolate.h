#pragma once

#include "sim/grid/face_fields.h"

#include <span>

namespace sim {

/// Sweeps of extrapolation: the stencil of a particle reaches faces three neighbours behind the last one in front of a wall.
inline constexpr int kExtrapolationSweeps = 3;

struct ExtrapolationScratch {
    BlockBits<3> newlyValid;
    BlockArray<double, 3> found;     ///< their velocities [cm/s]
};

/// Carry face velocities past the liquid's edge, in some of the blocks: in each sweep a face without a velocity takes the mean of those of its
/// six neighbours along the axes that had one before the sweep.
void extrapolate(const BlockGrid& grid, std::span<const int> blocks, ExtrapolationScratch& scratch, BlockBits<3>& valid,
                 BlockArray<double, 3>& velocity);

}  // namespace sim
