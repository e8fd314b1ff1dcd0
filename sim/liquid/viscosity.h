#pragma once

#include "sim/liquid/viscous_multigrid.h"
#include "sim/settings.h"
#include "sim/solvers/solve_report.h"

namespace sim {

/// What a solve for the viscosity needs beside the liquid's grid: grows once, and only where a scene asks for the
/// solve.
struct ViscosityWorkspace {
    ViscousSystem system;
    ViscousMultigrid multigrid;
    BlockArray<double, 3> residual, direction, applied;  ///< vectors of the conjugate gradients [g cm/s], [cm/s], [g cm/s]
    std::vector<double> sums, largest, largestRhs;       ///< dot product, largest residual and largest right-hand side of each block
    BlockArray<double, 3> withheld;                      ///< part of the velocities by weight and pressure that does not feel viscosity [cm/s]
};

/// Implicit steps of viscosity, settings.viscositySubsteps of them, over dt [s] on the velocities of the liquid's faces, before the
/// pressure makes them divergence-free (liquid/README.md, Viscosity): first order in time and stable for any viscosity. Conjugate gradients from the
/// velocities as they are, preconditioned by multigrid; the residual is relative to the largest momentum of a
/// face. Not converged after solver.maxIterations: told by the report, and the velocities are the last iterate's.
SolveReport solveViscosity(const CutGrid& cut, const LiquidSettings& settings, const SolverSettings& solver, double dt, ViscosityWorkspace& work,
                           LiquidGrid& liquid);

}  // namespace sim
