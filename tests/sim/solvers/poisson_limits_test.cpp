// Systems and guesses at the limits.
#include "tests/sim/solvers/poisson_solves.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

TEST(Poisson, OneCell)
{
    PoissonScene scene;
    scene.grid.setBlocks(std::vector<Vec3i>{{-3, 7, 1}});
    scene.matrix.resize(1);
    scene.rhs.resize(1);
    scene.matrix.diagonal(0)[345] = 4.0;
    scene.rhs.block(0)[345] = 6.0;
    BlockArray<double> p;
    const SolveReport report = solveFromZero(scene, p);
    EXPECT_LE(report.iterations, 1);
    EXPECT_NEAR(p.block(0)[345], 1.5, 1.0e-6);
}

TEST(Poisson, NothingToSolve)
{
    PoissonScene scene;
    scene.matrix.resize(0);
    scene.rhs.resize(0);
    BlockArray<double> p;
    SolveReport report = solveFromZero(scene, p);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);

    scene = boxWithSurface({12, 12, 12});
    for (int b = 0; b < scene.grid.count(); ++b)
        for (int c = 0; c < kBlockCells; ++c) scene.rhs.block(b)[c] = scene.isUnknown(b, c) ? 0.0 : 1.0;
    p = zeroPressure(scene);
    for (std::size_t i = 0; i < p.size() - kBlockCells; ++i) p.block(0)[i] = 3.0;
    report = PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_TRUE(sameBits(p, zeroPressure(scene)));
}

TEST(Poisson, CellsThatAreNoUnknownsEndWithoutPressure)
{
    const PoissonScene scene = boxWithSurface({20, 20, 20});
    BlockArray<double> p = zeroPressure(scene);
    for (std::size_t i = 0; i < p.size() - kBlockCells; ++i) p.block(0)[i] = 7.0;
    ASSERT_TRUE(PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p).converged);
    int others = 0;
    scene.forEachCell([&](const Vec3i&, int b, int c) {
        if (scene.isUnknown(b, c)) return;
        EXPECT_EQ(p.block(b)[c], 0.0);
        ++others;
    });
    EXPECT_GT(others, 1000);
    EXPECT_LE(relativeResidual(scene, p), 1.0e-6);
}

TEST(Poisson, SaysWhenItDidNotConverge)
{
    PoissonScene scene = boxWithSurface({32, 32, 32});
    BlockArray<double> p = zeroPressure(scene);
    SolveReport report = PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 3, p);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(report.iterations, 3);
    EXPECT_GT(report.residual, 1.0e-6);

    PoissonSolver solver;
    PoissonScene broken = scene;
    const CellRef at = broken.at({5, 5, 5});
    broken.rhs.block(at.block)[at.cell] = std::nan("");
    p = zeroPressure(scene);
    EXPECT_FALSE(solver.solve(scene.grid, scene.matrix, broken.rhs, 1.0e-6, 50, p).converged);
    p = zeroPressure(scene);  // and the next solve is none the worse
    EXPECT_TRUE(solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 50, p).converged);
    EXPECT_LE(relativeResidual(scene, p), 1.0e-6);
}

TEST(Poisson, FollowsASetOfBlocksThatChanges)
{
    PoissonSolver solver;
    for (int n : {40, 12, 33, 60, 7}) {
        const PoissonScene scene = boxWithSurface({n, n / 2 + 3, n}, {3 * n, -n, 5});
        BlockArray<double> p, fresh;
        const SolveReport report = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-8, 200, p);
        EXPECT_EQ(report.iterations, solveFromZero(scene, fresh, 1.0e-8).iterations);
        EXPECT_TRUE(sameBits(p, fresh));
    }
}

TEST(Poisson, GuessFarAboveTheSolutionIsDropped)
{
    const PoissonScene scene = boxWithSurface({20, 16, 20});
    PoissonScene faint = scene;
    for (int b = 0; b < faint.grid.count(); ++b)
        for (int c = 0; c < kBlockCells; ++c) faint.rhs.block(b)[c] *= 1.0e-14;
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(scene), fresh;
    ASSERT_TRUE(solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p).converged);
    const SolveReport report = solver.solve(faint.grid, faint.matrix, faint.rhs, 1.0e-6, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, solveFromZero(faint, fresh, 1.0e-6).iterations);
    EXPECT_TRUE(sameBits(p, fresh));
}

TEST(Poisson, BlocksThatRunDryLeaveNothingBehind)
{
    const PoissonScene wet = boxWithSurface({24, 20, 24});
    PoissonScene dry = wet;
    for (int b = 0; b < dry.grid.count(); ++b)
        if (dry.grid.coords(b).x() > 0) std::fill_n(dry.matrix.values.block(b), 4 * kBlockCells, 0.0);
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(wet), fresh;
    EXPECT_EQ(solver.solve(wet.grid, wet.matrix, wet.rhs, 1.0e-6, 2, p).iterations, 2);
    p = zeroPressure(dry);
    const SolveReport report = solver.solve(dry.grid, dry.matrix, dry.rhs, 1.0e-8, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, solveFromZero(dry, fresh, 1.0e-8).iterations);
    EXPECT_TRUE(sameBits(p, fresh));
}

}  // namespace
}  // namespace sim::test
