#pragma once

#include "sim/liquid/liquid_grid.h"
#include "sim/settings.h"
#include "sim/solvers/poisson.h"

namespace sim {

/// What the projection keeps from step to step beside the pressure itself.
struct PressureWorkspace {
    PoissonMatrix matrix;
    BlockArray<double> rhs;
    BlockArray<double, 3> coefficient;  ///< k_f = ω dt / (ρ dx²) of each lower face [cm s/g]
    PoissonSolver solver;
};

/// Make the velocities divergence-free: solve div(ω u + (1 − ω) v_S) = 0 for the pressure in all cells with a negative level set, with
/// p = 0 on the surface (ghost fluid) and subtract its gradient (model-fluid 6.4, 6.5 without fabric). Faces that got a velocity that
/// way are valid, all others not.
/// @param pressure  in: a guess, out: the solution [dyn/cm²]
SolveReport projectPressure(const BlockGrid& grid, const ObstacleField& obstacles, const LiquidSettings& settings, const SolverSettings& solver,
                            double dt, PressureWorkspace& work, LiquidGrid& liquid, BlockArray<double>& pressure);

/// Fraction of the way from a liquid cell to an air cell at which the surface lies, at least kThinnest.
inline constexpr double kThinnest = 0.01;

/// Largest |div(ω u + (1 − ω) v_S)| over the cells with a pressure [1/s].
double largestDivergence(const BlockGrid& grid, const ObstacleField& obstacles, const LiquidGrid& liquid);

}  // namespace sim
