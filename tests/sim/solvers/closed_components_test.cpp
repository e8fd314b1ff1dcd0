#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// Along x: walls at 17, 30 and 49 cut a box into four; the last is open at the top.
int roomOf(const Vec3i& c) { return c.x() < 17 ? 0 : c.x() < 30 ? 1 : c.x() < 49 ? 2 : 3; }

PoissonScene rooms()
{
    const Vec3i size(70, 20, 18);
    const auto inBox = boxWalls({0, 0, 0}, size), openTop = boxWalls({0, 0, 0}, {70, 100, 18});
    const auto open = [=](int axis, const Vec3i& c) {
        if (axis == 0 && roomOf(c) != roomOf(c - Vec3i::Unit(0))) return 0.0;
        return roomOf(c) == 3 ? openTop(axis, c) : inBox(axis, c);
    };
    return makeScene({{0, 0, 0},
                      size,
                      [](const Vec3& x) { return x.y() < 20 ? -1.0 : 1.0; },
                      open,
                      [](const Vec3i& c) { return 0.2 + 0.1 * roomOf(c) + roughRhs(c); }});
}

std::array<double, 4> meansOf(const PoissonScene& scene, const BlockArray<double>& v)
{
    std::array<double, 4> sum{}, cells{};
    scene.forEachCell([&](const Vec3i& cell, int b, int c) {
        if (!scene.isUnknown(b, c)) return;
        sum[roomOf(cell)] += v.block(b)[c];
        cells[roomOf(cell)] += 1.0;
    });
    for (int n = 0; n < 4; ++n) sum[n] /= cells[n];
    return sum;
}

TEST(ConnectedComponents, LoseTheirMeansAndOthersKeepThem)
{
    PoissonScene scene = rooms();
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(scene);
    for (int b = 0; b < scene.grid.count(); ++b) std::fill_n(p.block(b), kBlockCells, 100.0);
    const SolveReport report = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-8, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 30);
    EXPECT_EQ(solver.closedComponents(), 3);

    const auto pMeans = meansOf(scene, p), rhsMeans = meansOf(scene, scene.rhs);
    for (int n = 0; n < 3; ++n) {
        EXPECT_NEAR(pMeans[n], 0.0, 1.0e-10);
        EXPECT_GT(std::abs(rhsMeans[n]), 0.1);
    }
    EXPECT_GT(std::abs(pMeans[3]), 1.0);

    EXPECT_LE(relativeResidual(scene, p), 1.1e-8);
}

TEST(ConnectedComponents, AreFoundAcrossBlocksAndInTheSameBlock)
{
    // A closed pipe that winds through many blocks, and chequered lone pairs of cells, half of them closed.
    const auto isPipe = [](const Vec3i& c) { return c.z() == 0 && (c.y() % 4 == 0 || (c.x() == (c.y() / 4 % 2 == 0 ? 39 : 0))); };
    const auto isPair = [](const Vec3i& c) { return c.z() >= 2 && c.z() % 2 == 0 && c.y() % 2 == 0 && c.x() % 3 < 2 && c.x() < 39; };
    const Vec3i size(40, 33, 12);
    const auto phi = [=](const Vec3& x) {
        const Vec3i c = x.array().floor().cast<int>();
        const bool inside = (c.array() >= 0).all() && (c.array() < size.array()).all();
        return inside && (isPipe(c) || isPair(c)) ? -1.0 : 1.0;
    };
    const auto open = [=](int axis, const Vec3i& c) {
        const Vec3i below = c - Vec3i::Unit(axis);
        if (phi(c.cast<double>() + Vec3::Constant(0.5)) < 0 && phi(below.cast<double>() + Vec3::Constant(0.5)) < 0) return 1.0;
        return axis == 2 && c.z() >= 4 && c.z() % 4 == 0 && c.x() % 3 == 0 ? 1.0 : 0.0;
    };
    const PoissonScene scene = makeScene({{0, 0, 0}, size, phi, open, roughRhs});
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(scene);
    EXPECT_TRUE(solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p).converged);
    const int pairsPerLayer = 13 * 17;
    EXPECT_EQ(solver.closedComponents(), 1 + 3 * pairsPerLayer);  // layers 2, 6 and 10 are closed, 4 and 8 open
}

TEST(ConnectedComponents, ConstantRightHandSideOfAFullBoxIsNothing)
{
    PoissonScene scene = fullBox({20, 12, 9});
    for (int b = 0; b < scene.grid.count(); ++b) std::fill_n(scene.rhs.block(b), kBlockCells, 0.7);
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(scene);
    const SolveReport report = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.iterations, 0);
    EXPECT_TRUE(sameBits(p, zeroPressure(scene)));
}

TEST(ConnectedComponents, TightToleranceIsReached)
{
    const PoissonScene scene = fullBox({40, 40, 40});
    PoissonSolver solver;
    BlockArray<double> p = zeroPressure(scene);
    const SolveReport report = solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-12, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 25);
    EXPECT_LE(relativeResidual(scene, p), 2.0e-12);
}

}  // namespace
}  // namespace sim::test
