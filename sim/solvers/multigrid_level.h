#pragma once

#include "sim/solvers/multigrid.h"

// What one level of the hierarchy does.

namespace sim::multigrid {

enum class Order { Forward, Backward };

/// Coefficients of the finest level from the matrix. Dirichlet parts that are only rounding become 0.
void takeFinest(const BlockGrid& grid, const PoissonMatrix& matrix, MultigridLevel& level);

/// Coefficients of a coarse level from those of the next finer one.
void gatherCoarse(const MultigridLevel& fine, MultigridLevel& coarse);

/// Gauss-Seidel on the blocks of one colour, each with the given number of sweeps.
/// @param fromZero   x of this colour is taken as 0, whatever it holds
/// @param neighbours false: those of the other colour are taken as 0 as well
/// @param coarse     not null: its x is added to this one's first
void smooth(MultigridLevel& level, int colour, int sweeps, Order order, bool fromZero, bool neighbours,
            const MultigridLevel* coarse);

/// level.dot = r·x of each block.
void dotProducts(MultigridLevel& level);

/// coarse.r = sum of the residuals of the fine cells in each coarse one.
void restrictResidual(const MultigridLevel& fine, MultigridLevel& coarse);

/// fine.x += coarse.x on blocks of one colour.
void prolong(const MultigridLevel& coarse, MultigridLevel& fine, int colour);

}  // namespace sim::multigrid
