#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

int iterationsFromZero(const PoissonScene& scene)
{
    BlockArray<double> p = zeroPressure(scene);
    const SolveReport report = PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, p);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 15);
    return report.iterations;
}

TEST(PoissonSlow, IterationsAtTwoMillionCellsAreAtMostFortyPercentMore)
{
    EXPECT_LE(iterationsFromZero(boxWithSurface({128, 128, 128})), 1.4 * iterationsFromZero(boxWithSurface({32, 32, 32})));
    EXPECT_LE(iterationsFromZero(fullBox({128, 128, 128})), 1.4 * iterationsFromZero(fullBox({32, 32, 32})));
}

}  // namespace
}  // namespace sim::test
