#pragma once

#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

// Solves from a guess of zero.

namespace sim::test {

inline SolveReport solveFromZero(const PoissonScene& scene, BlockArray<double>& p, double tolerance = 1.0e-6)
{
    p = zeroPressure(scene);
    return PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, tolerance, 200, p);
}

}  // namespace sim::test
