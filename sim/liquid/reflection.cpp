#include "sim/liquid/reflection.h"

#include "sim/core/parallel.h"

#include <algorithm>

namespace sim {

namespace {

/// Of the solve: it moves second-order errors only; less where pressures are asked for to less than 1e-6.
double reflectionTolerance(const SolverSettings& solver) { return std::min(1.0e-3, 1.0e3 * solver.pressureTolerance); }

/// Farthest that the surface is taken to move: the pressure beyond it is that of a straight line from the slope at the surface [cells].
constexpr double kFarthest = 0.25;

/// Means over a row of cells of what their two faces across one axis have, of those that the pressure acts on.
struct MeanOnFaces {
    Pack velocity;  ///< u [cm/s]
    Pack change;    ///< u − u* [cm/s]
};
MeanOnFaces meanOnFaces(int axis, const RowAccess& rows, const PressureSystem& system, int j, int k)
{
    const LiquidGrid& liquid = system.liquid();
    const auto& u = liquid.faces.velocity;
    const Pack zero = broadcast(0.0), one = broadcast(1.0);
    const Pack under = select(rows.row(system.coefficient(), axis, j, k) > 0.0, one, zero);
    const Pack above = select(rows.above(system.coefficient(), axis, axis, j, k) > 0.0, one, zero);
    const Pack atLower = rows.row(u, axis, j, k), atUpper = rows.above(u, axis, axis, j, k);
    const Pack before = under * rows.row(liquid.advected, axis, j, k) + above * rows.above(liquid.advected, axis, axis, j, k);
    const Pack share = one / maxPack(under + above, one), now = under * atLower + above * atUpper;
    return {share * now, share * (now - before)};
}

/// The pressure at the surface: the surface moves by dt u until the next step projects what is reflected now, and the impulse of a pressure that is 0
/// where it was would not be that of one that is 0 where it is then, nor that of the weight (liquid/README.md, Reflection).
void findPressureAtSurface(const CutGrid& cut, const PressureSystem& system, const MovingSurface& surface, BlockArray<double>& pressure)
{
    const LiquidGrid& liquid = system.liquid();
    const double perCell = surface.dt / (kFarthest * cut.grid.dx);
    pressure.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(cut.grid, b);
        const Vec3 frame = surface.frames != nullptr ? surface.frames[b] : Vec3(Vec3::Zero());
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const PackMask known = rowBits(liquid.surface.block(b), j, k) & rowBits(surface.held.block(b), j, k);
                Pack power = broadcast(0.0), squared = broadcast(0.0);
                if (maskBits(known) != 0)
                    for (int a = 0; a < kAxes; ++a) {
                        const MeanOnFaces mean = meanOnFaces(a, rows, system, j, k);
                        const Pack moving = mean.velocity - frame[a];
                        power += moving * mean.change;
                        squared += moving * moving;
                    }
                const Pack bound = sqrtPack(maxPack(broadcast(1.0), squared * (perCell * perCell)));
                storePack(pressure.block(b) + cellInBlock(0, j, k), select(known, surface.density * power / bound, broadcast(0.0)));
            }
    });
}

/// Are there cells at the surface in a block, or in those below it along the axes, whose pressure acts on its faces?
bool hasSurface(const BlockGrid& grid, const BlockBits<>& surface, int block)
{
    const auto any = [&](int b) {
        return std::any_of(surface.block(b), surface.block(b) + BlockBits<>::kWords, [](std::uint64_t bits) { return bits != 0; });
    };
    return any(block) || std::any_of(std::begin(kBlockBelow), std::end(kBlockBelow), [&](int below) { return any(grid.neighbours(block)[below]); });
}

/// Add what the pressure at the surface does to the faces between liquid and air.
void pressOnSurface(const CutGrid& cut, const PressureSystem& system, const BlockArray<double>& pressure, BlockArray<double, 3>& velocities)
{
    const BlockBits<>& inside = system.liquid().inside;
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        if (!hasSurface(cut.grid, system.liquid().surface, b)) return;
        const BitAccess bits(cut.grid, b);
        for (int a = 0; a < kAxes; ++a)
            forEachPressureFace(cut, system, pressure, b, a, [&](int row, PackMask, Pack change) {
                const int j = row >> 3 & 7, k = row >> 6;
                const PackMask free = rowBits(inside.block(b)[k] ^ bits.below(inside, 0, a, k), j);
                double* velocity = velocities.block(b, a) + row;
                storePack(velocity, loadPack(velocity) - select(free, change, broadcast(0.0)));
            });
    });
}

}  // namespace

SolveReport reflect(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                    const MovingSurface& surface, ReflectionWorkspace& work)
{
    const LiquidGrid& liquid = system.liquid();
    findPressureAtSurface(cut, system, surface, work.atSurface);
    work.velocity = liquid.advected;
    pressOnSurface(cut, system, work.atSurface, work.velocity);
    findRightHandSide(cut, system, work.velocity, inflow, system.rightHandSide());
    work.potential.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 8, [&](std::size_t b) { std::fill_n(work.potential.block(static_cast<int>(b)), kBlockCells, 0.0); });
    const SolveReport report = system.solve(cut.grid, reflectionTolerance(solver), solver.maxIterations, work.potential);

    work.velocity = liquid.faces.velocity;
    pressOnSurface(cut, system, work.atSurface, work.velocity);
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
