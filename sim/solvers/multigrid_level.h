#pragma once

#include "sim/solvers/multigrid.h"

// What one level of the hierarchy does.

namespace sim::multigrid {

enum class Order { Forward, Backward };

/// Coefficients of the finest level from the matrix. Dirichlet parts that are only rounding become 0.
void takeFinest(const BlockGrid& grid, const PoissonMatrix& matrix, MultigridLevel& level);

/// Coefficients of a coarse level from those of the next finer one.
void gatherCoarse(const MultigridLevel& fine, MultigridLevel& coarse);

struct Smoothing {
    int colour = 0;  ///< colour of the blocks that are smoothed; the others stay as they are
    int sweeps = 1;  ///< number of sweeps in each block
    Order order = Order::Forward;
    bool fromZero = false;                   ///< x of these blocks is taken as 0, whatever it holds
    bool alone = false;                      ///< whether, with fromZero, x of the neighbours is taken as 0 too
    const MultigridLevel* coarse = nullptr;  ///< if given, its x is added to this one's first
    bool dots = false;                       ///< level.dot = r·x of each of these blocks, afterwards
};

/// Gauss-Seidel on the blocks of one colour.
void smooth(MultigridLevel& level, const Smoothing& smoothing);

/// coarse.r = sum of the residuals of the fine cells in each coarse one.
void restrictResidual(const MultigridLevel& fine, MultigridLevel& coarse);

/// fine.x += coarse.x on blocks of one colour.
void prolong(const MultigridLevel& coarse, MultigridLevel& fine, int colour);

}  // namespace sim::multigrid
