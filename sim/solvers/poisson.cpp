#include "sim/solvers/poisson.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <cmath>

namespace sim {

namespace {

BlockCouplings<double> couplingsOf(const PoissonMatrix& matrix, int b)
{
    return {matrix.coupling(0, b), matrix.coupling(1, b), matrix.coupling(2, b)};
}

std::array<int, 6> faceNeighbours(const BlockGrid& grid, int b)
{
    const auto& around = grid.neighbours(b);
    return {around[12], around[14], around[10], around[16], around[4], around[22]};
}

/// a or b, whichever is larger; not a number if one of them is not.
double larger(double a, double b)
{
    return b > a || b != b ? b : a;
}

Row<double> absolute(Row<double> v)
{
    return v < 0.0 ? -v : v;
}

Row<double> largerRow(Row<double> a, Row<double> b)
{
    return (b > a) | (b != b) ? b : a;
}

/// Ax of row r, its tile filled with a sum that began at 0.
Row<double> matrixTimes(const BlockCouplings<double>& couplings, const double* diagonal, const BlockTile<double>& tile, int r)
{
    const Row<double> v = loadRow(tile.row(r));
    return loadRow(diagonal + r * kBlockEdge) * v - couplings.acrossRows(tile, r) - couplings.alongRow(tile, r, v);
}

}  // namespace

/// residual = rhs − A p, its largest values, and all other vectors in order.
void PoissonSolver::startBlock(const Problem& problem, int b, bool isGuessZero)
{
    const double* diagonal = problem.matrix.diagonal(b);
    const double *rhs = problem.rhs.block(b), *p = problem.p.block(b);
    const BlockCouplings<double> couplings = couplingsOf(problem.matrix, b);
    const std::uint64_t rows = multigrid_.finest().rows[b];
    BlockTile<double> tile;
    tile.clear();
    std::fill_n(tile.sum, kBlockCells, 0.0);
    if (isGuessZero)
        tile.clearNeighbours();
    else {
        forEachRow(rows, [&](int r) { storeRow(tile.row(r), loadRow(p + r * kBlockEdge)); });
        addNeighbours(
            tile, b, faceNeighbours(problem.grid, b), [&](int n) { return couplingsOf(problem.matrix, n); },
            [&](int n, int r) { return loadRow(problem.p.block(n) + r * kBlockEdge); },
            [&](int n, int c) { return problem.p.block(n)[c]; });
    }
    Row<double> largestRhs = {}, largest = {};
    for (int r = 0; r < kBlockRows; ++r) {
        const int c = r * kBlockEdge;
        Row<double> v = {}, residual = {};
        if (rows >> r & 1) {
            v = loadRow(diagonal + c) > 0.0 ? loadRow(rhs + c) : v;
            residual = isGuessZero ? v : v - matrixTimes(couplings, diagonal, tile, r);
            residual = loadRow(diagonal + c) > 0.0 ? residual : Row<double>{};
        }
        largestRhs = largerRow(largestRhs, absolute(v));
        largest = largerRow(largest, absolute(residual));
        storeRow(residual_.block(b) + c, residual);
        storeRow(direction_.block(b) + c, Row<double>{});
        if (!(rows >> r & 1)) storeRow(nextDirection_.block(b) + c, Row<double>{});
    }
    norm_[b] = {maxOfRow<double>(largestRhs), maxOfRow<double>(largest)};
}

void PoissonSolver::start(const Problem& problem)
{
    const int n = problem.grid.count();
    multigrid_.build(problem.grid, problem.matrix);
    components_.find(problem.grid, problem.matrix);
    for (BlockArray<double>* v : {&residual_, &direction_, &nextDirection_, &applied_}) v->resize(n);
    dot_.resize(n);
    norm_.resize(n);

    bool isGuessZero = problem.p.size() != residual_.size();
    problem.p.resize(n);
    if (isGuessZero) forEachBlock(n, [&](int b) { std::fill_n(problem.p.block(b), kBlockCells, 0.0); });
    // Cells that are no unknowns keep no guess.
    const double largestGuess = parallelMax(n, [&](std::size_t block) {
        const int b = static_cast<int>(block);
        double* p = problem.p.block(b);
        const double* diagonal = problem.matrix.diagonal(b);
        Row<double> largest = {};
        for (int c = 0; c < kBlockCells; c += kBlockEdge) {
            const Row<double> v = loadRow(diagonal + c) > 0.0 ? loadRow(p + c) : Row<double>{};
            storeRow(p + c, v);
            largest = largerRow(largest, absolute(v));
        }
        return maxOfRow<double>(largest);
    });
    isGuessZero = largestGuess == 0.0;
    forEachBlock(n, [&](int b) { startBlock(problem, b, isGuessZero); });
    largestRhs_ = 0.0;
    for (const BlockNorms& norm : norm_) largestRhs_ = larger(largestRhs_, norm.rhs);

    if (components_.count() > 0) {
        components_.removeMeans(residual_);
        forEachBlock(n, [&](int b) {
            Row<double> largest = {};
            for (int c = 0; c < kBlockCells; c += kBlockEdge)
                largest = largerRow(largest, absolute(loadRow(residual_.block(b) + c)));
            norm_[b].residual = maxOfRow<double>(largest);
        });
    }
    scale_ = largestRhs_ > 0.0 && std::isfinite(largestRhs_) ? std::exp2(-std::ilogb(largestRhs_)) : 1.0;
    forEachBlock(n, [&](int b) {
        float* out = multigrid_.rightHandSide().block(b);
        for (int c = 0; c < kBlockCells; c += kBlockEdge)
            storeRow(out + c, toFloat(scale_ * loadRow(residual_.block(b) + c)));
    });
}

double PoissonSolver::largestResidual() const
{
    double largest = 0.0;
    for (const BlockNorms& norm : norm_) largest = larger(largest, norm.residual);
    return largest;
}

/// direction = z + beta direction, applied = A direction; returns their dot product.
double PoissonSolver::applyToDirection(const Problem& problem, double beta)
{
    const BlockArray<float>& z = multigrid_.solution();
    const auto row = [&](int n, int r) {
        const int c = r * kBlockEdge;
        return toDouble(loadRow(z.block(n) + c)) + beta * loadRow(direction_.block(n) + c);
    };
    const auto cell = [&](int n, int c) { return static_cast<double>(z.block(n)[c]) + beta * direction_.block(n)[c]; };
    forEachBlock(problem.grid.count(), [&](int b) {
        const std::uint64_t rows = multigrid_.finest().rows[b];
        const double* diagonal = problem.matrix.diagonal(b);
        const BlockCouplings<double> couplings = couplingsOf(problem.matrix, b);
        BlockTile<double> tile;
        tile.clear();
        std::fill_n(tile.sum, kBlockCells, 0.0);
        forEachRow(rows, [&](int r) { storeRow<double>(tile.row(r), row(b, r)); });
        addNeighbours(
            tile, b, faceNeighbours(problem.grid, b), [&](int n) { return couplingsOf(problem.matrix, n); }, row, cell);
        Row<double> sum = {};
        forEachRow(rows, [&](int r) {
            const Row<double> v = loadRow(tile.row(r)), a = matrixTimes(couplings, diagonal, tile, r);
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
        norm_[b].residual = maxOfRow<double>(largest);
    });
    return largestResidual();
}

void PoissonSolver::conjugateGradients(const Problem& problem, double target, int maxIterations, SolveReport& report)
{
    double residual = largestResidual(), rho = 0.0;
    while (residual > target && report.iterations < maxIterations) {
        const double next = multigrid_.cycle() / scale_;
        components_.removeMeans(multigrid_.solution());
        const double beta = rho > 0.0 ? next / rho : 0.0;
        rho = next;
        const double alpha = rho / applyToDirection(problem, beta);
        if (!std::isfinite(alpha) || alpha <= 0.0) break;
        residual = advance(problem, alpha);
        ++report.iterations;
    }
    report.converged = residual <= target;
    report.residual = residual / largestRhs_;
}

SolveReport PoissonSolver::solve(const BlockGrid& grid, const PoissonMatrix& matrix, const BlockArray<double>& rhs,
                                 double tolerance, int maxIterations, BlockArray<double>& p)
{
    SIM_CHECK(matrix.values.size() == (grid.count() + std::size_t{1}) * 4 * kBlockCells);
    SIM_CHECK(rhs.size() == (grid.count() + std::size_t{1}) * kBlockCells);
    const Problem problem{grid, matrix, rhs, p};
    start(problem);
    SolveReport report;
    if (largestRhs_ == 0.0) {
        forEachBlock(grid.count(), [&](int b) { std::fill_n(p.block(b), kBlockCells, 0.0); });
        return report;
    }
    conjugateGradients(problem, tolerance * largestRhs_, maxIterations, report);
    components_.removeMeans(p);
    return report;
}

}  // namespace sim
