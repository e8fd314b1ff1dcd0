#include "sim/liquid/reflection.h"

#include "sim/core/parallel.h"

#include <algorithm>

namespace sim {

namespace {

/// Of the solve: it moves second-order errors only; less where pressures are asked for to less than 1e-6.
double reflectionTolerance(const SolverSettings& solver) { return std::min(1.0e-3, 1.0e3 * solver.pressureTolerance); }

}  // namespace

SolveReport reflect(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                    ReflectionWorkspace& work)
{
    const LiquidGrid& liquid = system.liquid();
    findRightHandSide(cut, system, liquid.advected, inflow, system.rightHandSide());
    work.potential.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 8, [&](std::size_t b) { std::fill_n(work.potential.block(static_cast<int>(b)), kBlockCells, 0.0); });
    const SolveReport report = system.solve(cut.grid, reflectionTolerance(solver), solver.maxIterations, work.potential);

    work.velocity = liquid.faces.velocity;
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a)
            forEachPressureFace(cut, system, work.potential, b, a, [&](int row, PackMask, Pack change) {
                double* velocity = work.velocity.block(b, a) + row;
                storePack(velocity, loadPack(velocity) + change);
            });
    });
    work.valid = liquid.faces.valid;
    return report;
}

}  // namespace sim
