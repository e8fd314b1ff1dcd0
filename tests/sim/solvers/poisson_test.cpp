#include "tests/sim/solvers/poisson_solves.h"

#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace sim::test {
namespace {

/// The unknowns in a row, for dense matrices.
std::vector<Vec3i> unknownsOf(const PoissonScene& scene)
{
    std::vector<Vec3i> cells;
    scene.forEachCell([&](const Vec3i& cell, int b, int c) {
        if (scene.isUnknown(b, c)) cells.push_back(cell);
    });
    return cells;
}

Eigen::MatrixXd denseMatrix(const PoissonScene& scene, const std::vector<Vec3i>& cells)
{
    const int n = static_cast<int>(cells.size());
    Eigen::MatrixXd a(n, n);
    for (int column = 0; column < n; ++column) {
        BlockArray<double> unit = zeroPressure(scene);
        const CellRef at = scene.at(cells[column]);
        unit.block(at.block)[at.cell] = 1.0;
        for (int row = 0; row < n; ++row) a(row, column) = matrixTimes(scene, unit, cells[row]);
    }
    return a;
}

TEST(Poisson, ReachesTheToleranceItReports)
{
    for (const PoissonScene& scene : {poolWithWaves(60), boxWithSurface({32, 32, 32}), fullBox({24, 17, 9})})
        for (double tolerance : {1.0e-3, 1.0e-6, 1.0e-9}) {
            BlockArray<double> p;
            const SolveReport report = solveFromZero(scene, p, tolerance);
            EXPECT_TRUE(report.converged);
            EXPECT_LE(report.residual, tolerance);
            EXPECT_LE(relativeResidual(scene, p), tolerance + 1.0e-12);
            EXPECT_NEAR(relativeResidual(scene, p), report.residual, 0.01 * report.residual + 1.0e-12);
        }
}

TEST(Poisson, AgreesWithDenseFactorisation)
{
    std::mt19937 random(1);
    for (int repeat = 0; repeat < 12; ++repeat) {
        const PoissonScene scene = randomScene(random, {9, 5 + repeat % 4, 7}, {4, -3, 5}, 0.5 + 0.04 * repeat);
        const std::vector<Vec3i> cells = unknownsOf(scene);
        const Eigen::MatrixXd a = denseMatrix(scene, cells);
        ASSERT_EQ(a, a.transpose());
        Eigen::VectorXd rhs(a.rows());
        for (int n = 0; n < a.rows(); ++n) rhs[n] = scene.value(scene.rhs, cells[n]);
        const Eigen::VectorXd exact = a.ldlt().solve(rhs);

        BlockArray<double> p;
        ASSERT_TRUE(solveFromZero(scene, p, 1.0e-13).converged);
        ASSERT_GT(exact.norm(), 0.0);
        for (int n = 0; n < a.rows(); ++n) EXPECT_NEAR(scene.value(p, cells[n]), exact[n], 1.0e-8 * exact.lpNorm<Eigen::Infinity>());
    }
}

TEST(Poisson, IterationsGrowLittleWithSize)
{
    BlockArray<double> p;
    EXPECT_LE(solveFromZero(boxWithSurface({32, 32, 32}), p).iterations, 11);
    EXPECT_LE(solveFromZero(boxWithSurface({64, 64, 64}), p).iterations, 12);
    EXPECT_LE(solveFromZero(fullBox({32, 32, 32}), p).iterations, 11);
    EXPECT_LE(solveFromZero(fullBox({64, 64, 64}), p).iterations, 12);
    EXPECT_LE(solveFromZero(poolWithWaves(), p).iterations, 12);
}

TEST(Poisson, LongThinAndFlatBoxesConvergeAsWell)
{
    for (const Vec3i& n : {Vec3i(200, 12, 3), Vec3i(3, 160, 5), Vec3i(5, 9, 150), Vec3i(1, 1, 120), Vec3i(90, 1, 90)}) {
        BlockArray<double> p;
        EXPECT_LE(solveFromZero(boxWithSurface(n), p).iterations, 15) << n.transpose();
        EXPECT_LE(solveFromZero(fullBox(n), p).iterations, 15) << n.transpose();
    }
}

TEST(Poisson, ThinCellsAndNearSurfacesConverge)
{
    // Walls and surface as of a liquid in a tank that is not aligned with the grid: thin cells along the walls.
    const Vec3i n(60, 50, 40);
    const auto wall = [](int axis, const Vec3i& c) {
        const Vec3 x = c.cast<double>() + Vec3(axis == 0 ? 0.0 : 0.5, axis == 1 ? 0.0 : 0.5, axis == 2 ? 0.0 : 0.5);
        const double distance = std::min({x.x() + 0.3 * x.y() - 9.0, 58.0 + 0.1 * x.y() - x.x(), x.y() + 0.2 * x.z() - 5.0,
                                          x.z() - 0.15 * x.x() - 2.0, 39.0 - 0.05 * x.y() - x.z()});
        const double open = std::clamp(distance + 0.5, 0.0, 1.0);
        return open < 1.0e-3 ? 0.0 : open;
    };
    const auto phi = [](const Vec3& x) { return x.y() - 30.0 - 4.0 * std::sin(0.3 * x.x()) * std::cos(0.2 * x.z()); };
    const PoissonScene tank = makeScene({{0, 0, 0}, n, phi, wall, roughRhs});
    BlockArray<double> p;
    EXPECT_LE(solveFromZero(tank, p).iterations, 15);
    EXPECT_LE(relativeResidual(tank, p), 1.0e-6);

    // Worse than any liquid: every face at random, a quarter closed, the others open by 1e-3 to 1.
    std::mt19937 random(2);
    for (double share : {0.5, 0.7, 0.9, 0.99}) {
        const PoissonScene scene = randomScene(random, {48, 40, 36}, {-20, -20, -20}, share);
        const SolveReport report = solveFromZero(scene, p);
        EXPECT_TRUE(report.converged);
        EXPECT_LE(report.iterations, 75) << share;
        EXPECT_LE(relativeResidual(scene, p), 1.0e-6);
    }
}

/// 5000 drops of 1 to 20 cells, strewn over a pool.
PoissonScene spray()
{
    std::mt19937 random(3);
    const Vec3i size(160, 144, 160);
    std::vector<char> liquid(static_cast<std::size_t>(size.prod()), 0);
    const auto index = [&](const Vec3i& c) { return (c.z() * size.y() + c.y()) * size.x() + c.x(); };
    for (int drop = 0; drop < 5000; ++drop) {
        Vec3i c(static_cast<int>(random() % 160), 32 + static_cast<int>(random() % 112), static_cast<int>(random() % 160));
        for (int n = 1 + static_cast<int>(random() % 20); n > 0; --n) {
            liquid[index(c)] = 1;
            const int axis = static_cast<int>(random() % 3);
            c[axis] = std::clamp(c[axis] + (random() % 2 == 0 ? 1 : -1), axis == 1 ? 32 : 0, size[axis] - 1);
        }
    }
    const auto phi = [=](const Vec3& x) {
        const Vec3i c = x.array().floor().cast<int>();
        const bool inside = (c.array() >= 0).all() && (c.array() < size.array()).all();
        return inside && (c.y() < 24 || liquid[index(c)]) ? -0.4 : 0.6;
    };
    return makeScene({Vec3i(0, 0, 0), size, phi, boxWalls(Vec3i(0, 0, 0), size), roughRhs});
}

TEST(Poisson, ThousandsOfDropsNeedNoMoreIterationsThanThePool)
{
    const PoissonScene scene = spray();
    BlockArray<double> p;
    const SolveReport report = solveFromZero(scene, p);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 15);
    EXPECT_LE(relativeResidual(scene, p), 1.0e-6);
}

TEST(Poisson, WarmStartNeverNeedsMoreIterations)
{
    for (PoissonScene scene : {poolWithWaves(60), boxWithSurface({32, 32, 32}), fullBox({32, 24, 16})}) {
        PoissonSolver solver;
        BlockArray<double> p = zeroPressure(scene);
        const int cold = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p).iterations;
        EXPECT_EQ(solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p).iterations, 0);
        scene.forEachCell([&](const Vec3i& cell, int b, int c) { scene.rhs.block(b)[c] *= 1.0 + 0.01 * std::sin(0.3 * cell.x() + 0.2 * cell.y()); });
        const SolveReport warm = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p);
        EXPECT_LT(warm.iterations, cold);
        EXPECT_LE(relativeResidual(scene, p), 1.0e-6);
    }
}

TEST(Poisson, DependsOnShapeNotOnPlace)
{
    const Vec3i n(37, 21, 18);
    BlockArray<double> here, there;
    const SolveReport a = solveFromZero(boxWithSurface(n, {0, 0, 0}), here);
    for (const Vec3i& corner : {Vec3i(-24, -8, -16), Vec3i(80008, -400000, 8), Vec3i(-8000000, 7999992, 16)}) {
        const SolveReport b = solveFromZero(boxWithSurface(n, corner), there);
        EXPECT_EQ(a.iterations, b.iterations);
        ASSERT_EQ(here.size(), there.size());
        double largest = 0.0, difference = 0.0;
        for (std::size_t i = 0; i < here.size(); ++i) {
            largest = std::max(largest, std::abs(here.block(0)[i]));
            difference = std::max(difference, std::abs(here.block(0)[i] - there.block(0)[i]));
        }
        EXPECT_LE(difference, 1.0e-6 * largest);  // the surface is rounded differently far away
    }
}

TEST(Poisson, ScaleOfNumbersDoesNotMatter)
{
    const PoissonScene scene = boxWithSurface({24, 20, 16});
    BlockArray<double> p, q;
    const SolveReport a = solveFromZero(scene, p);
    PoissonScene small = scene;
    for (std::size_t i = 0; i < small.matrix.values.size(); ++i) small.matrix.values.block(0)[i] *= std::exp2(-40);
    for (std::size_t i = 0; i < small.rhs.size(); ++i) small.rhs.block(0)[i] *= std::exp2(-120);
    const SolveReport b = solveFromZero(small, q);
    EXPECT_EQ(a.iterations, b.iterations);
    for (std::size_t i = 0; i < q.size(); ++i) q.block(0)[i] *= std::exp2(80);
    EXPECT_TRUE(sameBits(p, q));
}

}  // namespace
}  // namespace sim::test
