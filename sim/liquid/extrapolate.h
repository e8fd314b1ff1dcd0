#pragma once

#include "sim/liquid/liquid_grid.h"
#include "sim/particles/particle_order.h"

#include <vector>

namespace sim {

/// Sweeps of extrapolation: the stencil of a particle in a lone liquid cell reaches faces three neighbours away (model-fluid 6.6).
inline constexpr int kExtrapolationSweeps = 3;

struct ExtrapolationScratch {
    BlockBits<3> newlyValid;
};

/// Carry face velocities past the liquid's edge: in each sweep a face without a velocity takes the mean of those of its six neighbours
/// along the axes that had one before the sweep.
void extrapolate(const BlockGrid& grid, ExtrapolationScratch& scratch, BlockBits<3>& valid, BlockArray<double, 3>& velocity);

/// Mark the cells with particles whose stencils hold faces without a velocity.
void findGaps(const BlockGrid& grid, const ParticleOrder& order, LiquidGrid& liquid);

}  // namespace sim
