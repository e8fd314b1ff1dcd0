#pragma once

#include "sim/solvers/components.h"
#include "sim/solvers/framed_tile.h"
#include "sim/solvers/multigrid.h"
#include "sim/solvers/poisson_matrix.h"
#include "sim/solvers/solve_report.h"

#include <cstdint>
#include <vector>

namespace sim {

/// How large the largest residual of a solution may be: whatever of these allows more.
struct SolveTolerance {
    SolveTolerance(double ofRightHandSide, double atLeast = 0.0) : relative(ofRightHandSide), absolute(atLeast) {}
    double relative;  ///< largest residual relative to the largest right-hand side [-]
    double absolute;  ///< largest residual [the unit of the right-hand side]
};

/// Solves A p = rhs by conjugate gradients in double, preconditioned by one multigrid cycle in float. Keeps the
/// hierarchy and all vectors from call to call: once they have grown to size, nothing is allocated.
///
/// On components without a Dirichlet part the matrix leaves a constant undetermined: the mean of rhs over each is
/// ignored, and that of p is 0.
class PoissonSolver {
 public:
    /// Make ready to solve with this matrix: its hierarchy and its components.
    void prepare(const BlockGrid& grid, const PoissonMatrix& matrix);
    /// First half of prepare(), after which values of the matrix may still change: its components.
    void findComponents(const BlockGrid& grid, const PoissonMatrix& matrix);
    /// Second half of prepare(): its hierarchy.
    void buildHierarchy(const BlockGrid& grid, const PoissonMatrix& matrix);

    /// @param matrix, rhs   on the blocks of the grid; what rhs has in cells that are no unknowns is ignored
    /// @param p             in: a guess (dropped if its residual is larger than the right-hand side), out: the solution; 0 in cells
    ///                      that are no unknowns. If it has not the size of the grid, it is resized and the guess is 0.
    /// Not converged after maxIterations, or numbers that are not finite: told by the report.
    SolveReport solve(const BlockGrid& grid, const PoissonMatrix& matrix, const BlockArray<double>& rhs, SolveTolerance tolerance, int maxIterations,
                      BlockArray<double>& p);

    /// Solves with the matrix that was last prepared or solved.
    SolveReport solveAgain(const BlockGrid& grid, const PoissonMatrix& matrix, const BlockArray<double>& rhs, SolveTolerance tolerance,
                           int maxIterations, BlockArray<double>& p);

    /// The preconditioner, as the last solve left it.
    Multigrid& multigrid() { return multigrid_; }
    /// Components without a Dirichlet part.
    int closedComponents() const { return components_.closedCount(); }
    const ConnectedComponents& components() const { return components_; }

 private:
    struct Problem {
        const BlockGrid& grid;
        const PoissonMatrix& matrix;
        const BlockArray<double>& rhs;
        BlockArray<double>& p;
    };

    SolveReport solvePrepared(const Problem& problem, SolveTolerance tolerance, int maxIterations);
    void start(const Problem& problem);
    double measure(const Problem& problem);
    void startBlock(const Problem& problem, int block, bool isGuessZero, FramedTile<double>& tile);
    BlockCouplings<double> couplings(const Problem& problem, int block) const;
    void conjugateGradients(const Problem& problem, double target, int maxIterations, SolveReport& report);
    double applyToDirection(const Problem& problem, bool isFirst, double beta);
    double advance(const Problem& problem, double alpha);

    Multigrid multigrid_;
    ConnectedComponents components_;
    BlockArray<double> residual_, direction_, nextDirection_, applied_;
    AlignedArray<double> rightCoupling_;   ///< coupling of each row beyond its right end, 64 per block
    std::vector<double> dot_;              ///< direction · A direction of each block
    std::vector<double> largestGuess_;     ///< largest guess of each block
    std::vector<double> largestResidual_;  ///< largest residual of each block
    std::vector<double> largestRhsOfBlock_;
    double largestRhs_ = 0.0;
    double scale_ = 1.0;  ///< power of two that brings residuals near 1 for the float cycle
};

}  // namespace sim
