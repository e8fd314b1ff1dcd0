#include "sim/solvers/poisson.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// a or b, whichever is larger; not a number if one of them is not.
double larger(double a, double b) { return b > a || b != b ? b : a; }

Row<double> absolute(Row<double> v) { return v < 0.0 ? -v : v; }

// NOLINTNEXTLINE(misc-redundant-expression): b != b where b is NaN
Row<double> largerRow(Row<double> a, Row<double> b) { return (b > a) | (b != b) ? b : a; }

double largestOf(const std::vector<double>& values)
{
    double largest = 0.0;
    for (double v : values) largest = larger(largest, v);
    return largest;
}

/// Ax of row r, its tile filled with a sum that began at 0.
[[gnu::always_inline]] inline Row<double> matrixTimes(const BlockCouplings<double>& couplings, const double* diagonal, const FramedTile<double>& tile,
                                                      int r)
{
    const Row<double> v = loadRow(tile.row(r));
    return loadRow(diagonal + r * kBlockEdge) * v - couplings.acrossRows(tile, r) - couplings.alongRow(tile, r, v);
}

}  // namespace

BlockCouplings<double> PoissonSolver::couplings(const Problem& problem, int b) const
{
    return {problem.matrix.coupling(0, b), problem.matrix.coupling(1, b), problem.matrix.coupling(2, b),
            rightCoupling_.data() + b * std::size_t{kBlockRows}};
}

/// Clear the guess in cells that are no unknowns and find the largest right-hand side; returns the largest guess.
double PoissonSolver::measure(const Problem& problem)
{
    forEachBlock(problem.grid.count(), [&](int b) {
        const double *diagonal = problem.matrix.diagonal(b), *rhs = problem.rhs.block(b);
        const double* beyondX = problem.matrix.coupling(0, problem.grid.neighbours(b)[neighbourIndex(1, 0, 0)]);
        double* p = problem.p.block(b);
        Row<double> largestRhs = {}, largestGuess = {};
        for (int c = 0; c < kBlockCells; c += kBlockEdge) {
            const auto isUnknown = loadRow(diagonal + c) > 0.0;
            const Row<double> guess = isUnknown ? loadRow(p + c) : Row<double>{};
            storeRow(p + c, guess);
            largestGuess = largerRow(largestGuess, absolute(guess));
            largestRhs = largerRow(largestRhs, absolute(isUnknown ? loadRow(rhs + c) : Row<double>{}));
            rightCoupling_[b * std::size_t{kBlockRows} + c / kBlockEdge] = beyondX[c];
        }
        largestGuess_[b] = maxOfRow<double>(largestGuess);
        largestRhsOfBlock_[b] = maxOfRow<double>(largestRhs);
    });
    largestRhs_ = largestOf(largestRhsOfBlock_);
    return largestOf(largestGuess_);
}

/// residual = rhs − A p, and 0 in the rows of all vectors that hold no unknowns.
void PoissonSolver::startBlock(const Problem& problem, int b, bool isGuessZero, FramedTile<double>& tile)
{
    const double *diagonal = problem.matrix.diagonal(b), *rhs = problem.rhs.block(b), *p = problem.p.block(b);
    const BlockCouplings<double> own = couplings(problem, b);
    const std::uint64_t rows = multigrid_.finest().rows[b];
    if (!isGuessZero) {
        tile.fill(rows, [&](int r) { return loadRow(p + r * kBlockEdge); });
        tile.clearSum();
        addNeighbours(
            tile, b, problem.grid.neighboursAtSides(b), [&](int n) { return couplings(problem, n); },
            [&](int n, int r) { return loadRow(problem.p.block(n) + r * kBlockEdge); }, [&](int n, int c) { return problem.p.block(n)[c]; });
    }
    Row<double> largest = {};
    forEachRow(rows, [&](int r) {
        const int c = r * kBlockEdge;
        Row<double> residual = loadRow(rhs + c);
        if (!isGuessZero) residual -= matrixTimes(own, diagonal, tile, r);
        residual = loadRow(diagonal + c) > 0.0 ? residual : Row<double>{};
        largest = largerRow(largest, absolute(residual));
        storeRow(residual_.block(b) + c, residual);
        storeRow(multigrid_.rightHandSide().block(b) + c, toFloat(scale_ * residual));
    });
    largestResidual_[b] = maxOfRow<double>(largest);
    forEachRow(~rows, [&](int r) {
        for (BlockArray<double>* v : {&residual_, &direction_, &nextDirection_}) storeRow(v->block(b) + r * kBlockEdge, Row<double>{});
    });
}

void PoissonSolver::start(const Problem& problem)
{
    const int n = problem.grid.count();
    const bool isNew = problem.p.size() != (n + std::size_t{1}) * kBlockCells;
    for (BlockArray<double>* v : {&residual_, &direction_, &nextDirection_, &applied_, &problem.p}) v->resize(n);
    if (isNew) forEachBlock(n, [&](int b) { std::fill_n(problem.p.block(b), kBlockCells, 0.0); });
    rightCoupling_.resize(n * std::size_t{kBlockRows});
    for (std::vector<double>* v : {&dot_, &largestGuess_, &largestResidual_, &largestRhsOfBlock_}) v->resize(n);

    const bool isGuessZero = measure(problem) == 0.0;
    scale_ = largestRhs_ > 0.0 && std::isfinite(largestRhs_) ? std::exp2(-std::ilogb(largestRhs_)) : 1.0;
    const auto findResidual = [&](bool fromZero) {
        forEachBlockInTile<FramedTile<double>>(n, [&](int b, FramedTile<double>& tile) { startBlock(problem, b, fromZero, tile); });
    };
    findResidual(isGuessZero);
    if (!isGuessZero && !(largestOf(largestResidual_) <= largestRhs_)) {
        // Worse than none: of a pressure far above the solution, rounding alone may be larger than what there is to solve.
        forEachBlock(n, [&](int b) { std::fill_n(problem.p.block(b), kBlockCells, 0.0); });
        findResidual(true);
    }
    if (components_.closedCount() == 0) return;

    components_.removeMeans(residual_);
    forEachBlock(n, [&](int b) {
        Row<double> largest = {};
        for (int c = 0; c < kBlockCells; c += kBlockEdge) {
            const Row<double> r = loadRow(residual_.block(b) + c);
            largest = largerRow(largest, absolute(r));
            storeRow(multigrid_.rightHandSide().block(b) + c, toFloat(scale_ * r));
        }
        largestResidual_[b] = maxOfRow<double>(largest);
    });
}

/// direction = z + beta direction, applied = A direction; returns their dot product.
double PoissonSolver::applyToDirection(const Problem& problem, bool isFirst, double beta)
{
    const BlockArray<float>& z = multigrid_.solution();
    const auto row = [&](int n, int r) {
        const Row<double> v = toDouble(loadRow(z.block(n) + r * kBlockEdge));
        return isFirst ? v : Row<double>(v + beta * loadRow(direction_.block(n) + r * kBlockEdge));
    };
    const auto cell = [&](int n, int c) {
        const double v = static_cast<double>(z.block(n)[c]);
        return isFirst ? v : v + beta * direction_.block(n)[c];
    };
    forEachBlockInTile<FramedTile<double>>(problem.grid.count(), [&](int b, FramedTile<double>& tile) {
        const std::uint64_t rows = multigrid_.finest().rows[b];
        const double* diagonal = problem.matrix.diagonal(b);
        const BlockCouplings<double> own = couplings(problem, b);
        tile.fill(rows, [&](int r) { return row(b, r); });
        tile.clearSum();
        addNeighbours(
            tile, b, problem.grid.neighboursAtSides(b), [&](int n) { return couplings(problem, n); }, row, cell);
        Row<double> sum = {};
        forEachRow(rows, [&](int r) {
            const Row<double> v = loadRow(tile.row(r)), a = matrixTimes(own, diagonal, tile, r);
            storeRow(nextDirection_.block(b) + r * kBlockEdge, v);
            storeRow(applied_.block(b) + r * kBlockEdge, a);
            sum += v * a;
        });
        dot_[b] = sumOfRow<double>(sum);
    });
    direction_.swap(nextDirection_);
    double sum = 0.0;
    for (double d : dot_) sum += d;
    return sum;
}

/// One step of length alpha along the direction; returns the largest residual.
double PoissonSolver::advance(const Problem& problem, double alpha)
{
    forEachBlock(problem.grid.count(), [&](int b) {
        double *p = problem.p.block(b), *residual = residual_.block(b);
        const double *direction = direction_.block(b), *applied = applied_.block(b);
        float* out = multigrid_.rightHandSide().block(b);
        Row<double> largest = {};
        forEachRow(multigrid_.finest().rows[b], [&](int row) {
            const int c = row * kBlockEdge;
            const Row<double> r = loadRow(residual + c) - alpha * loadRow(applied + c);
            storeRow<double>(p + c, loadRow(p + c) + alpha * loadRow(direction + c));
            storeRow(residual + c, r);
            storeRow(out + c, toFloat(scale_ * r));
            largest = largerRow(largest, absolute(r));
        });
        largestResidual_[b] = maxOfRow<double>(largest);
    });
    return largestOf(largestResidual_);
}

void PoissonSolver::conjugateGradients(const Problem& problem, double target, int maxIterations, SolveReport& report)
{
    double residual = largestOf(largestResidual_), rho = 0.0;
    while (residual > target && report.iterations < maxIterations) {
        const double next = multigrid_.cycle() / scale_;
        components_.removeMeans(multigrid_.solution());
        const double energy = applyToDirection(problem, report.iterations == 0, next / rho);
        rho = next;
        const double alpha = rho / energy;
        if (!std::isfinite(alpha) || alpha <= 0.0) break;
        residual = advance(problem, alpha);
        ++report.iterations;
    }
    report.converged = residual <= target;
    report.residual = residual / largestRhs_;
    report.scale = largestRhs_;
}

SolveReport PoissonSolver::solvePrepared(const Problem& problem, SolveTolerance tolerance, int maxIterations)
{
    SIM_CHECK(problem.rhs.size() == (problem.grid.count() + std::size_t{1}) * kBlockCells);
    start(problem);
    SolveReport report;
    if (largestRhs_ == 0.0) {
        forEachBlock(problem.grid.count(), [&](int b) { std::fill_n(problem.p.block(b), kBlockCells, 0.0); });
        return report;
    }
    conjugateGradients(problem, std::max(tolerance.relative * largestRhs_, tolerance.absolute), maxIterations, report);
    components_.removeMeans(problem.p);
    return report;
}

void PoissonSolver::prepare(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    findComponents(grid, matrix);
    buildHierarchy(grid, matrix);
}

void PoissonSolver::findComponents(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    SIM_CHECK(matrix.values.size() == (grid.count() + std::size_t{1}) * 4 * kBlockCells);
    components_.find(grid, matrix);
}

void PoissonSolver::buildHierarchy(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    SIM_CHECK(matrix.values.size() == (grid.count() + std::size_t{1}) * 4 * kBlockCells);
    multigrid_.build(grid, matrix);
}

SolveReport PoissonSolver::solve(const BlockGrid& grid, const PoissonMatrix& matrix, const BlockArray<double>& rhs, SolveTolerance tolerance,
                                 int maxIterations, BlockArray<double>& p)
{
    prepare(grid, matrix);
    return solvePrepared({grid, matrix, rhs, p}, tolerance, maxIterations);
}

SolveReport PoissonSolver::solveAgain(const BlockGrid& grid, const PoissonMatrix& matrix, const BlockArray<double>& rhs, SolveTolerance tolerance,
                                      int maxIterations, BlockArray<double>& p)
{
    SIM_CHECK(multigrid_.finest().blocks() == grid.count());
    return solvePrepared({grid, matrix, rhs, p}, tolerance, maxIterations);
}

}  // namespace sim
