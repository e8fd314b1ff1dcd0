#include "sim/liquid/volume.h"

#include "sim/core/parallel.h"
#include "sim/liquid/cells.h"

#include <algorithm>

namespace sim {

namespace {

constexpr double kVolumeTolerance = 1.0e-2;  ///< of the solve: what is left is corrected next time
constexpr double kFillBelowSurface =
    0.8;  ///< of cells beside surface cells, at least, while the liquid is in one piece
constexpr double kLargestError =
    1.0;  ///< a cell that holds more than twice its volume expands like one that holds twice

/// Volume that a cell lacks (negative) or has too much, relative to its own. Cells at the surface may hold as little as
/// they like.
double volumeError(double fill, bool atSurface, bool deep)
{
    const double least = atSurface ? 0.0 : deep ? 1.0 : kFillBelowSurface;
    return fill > 1.0 ? std::min(fill - 1.0, kLargestError) : std::min(fill - least, 0.0);
}

void findSources(const BlockGrid& grid, const LiquidGrid& liquid, double strength, BlockArray<double>& source)
{
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int c = 0; c < kBlockCells; ++c) {
            const bool inside = liquid.inside.test(b, c);
            source.block(b)[c] = inside ? strength * volumeError(liquid.fill.block(b)[c], liquid.surface.test(b, c),
                                                                 liquid.deep.test(b, c))
                                        : 0.0;
        }
    });
}

void displaceFaces(const BlockGrid& grid, const ObstacleField& obstacles, const PressureWorkspace& pressure,
                   VolumeWorkspace& work)
{
    const Pack largest = broadcast(kLargestCorrection * grid.dx);
    parallelFor(grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            double* displacement = work.displacement.block(b, a);
            std::fill_n(displacement, kBlockCells, 0.0);
            forEachPressureFace(grid, obstacles, pressure, work.potential, b, a, [&](int row, PackMask, Pack change) {
                const Pack bounded = maxPack(-largest, -maxPack(-largest, -change));
                std::memcpy(displacement + row, &bounded, sizeof bounded);
            });
        }
    });
}

}  // namespace

SolveReport correctVolume(const BlockGrid& grid, const ObstacleField& obstacles, PressureWorkspace& pressure,
                          const LiquidGrid& liquid, double strength, int maxIterations, VolumeWorkspace& work)
{
    work.potential.resize(grid.count());
    work.displacement.resize(grid.count());
    parallelFor(grid.count(), 8,
                [&](std::size_t b) { std::fill_n(work.potential.block(static_cast<int>(b)), kBlockCells, 0.0); });
    findSources(grid, liquid, strength, pressure.rhs);
    const SolveReport report =
        pressure.solver.solveAgain(grid, pressure.matrix, pressure.rhs, kVolumeTolerance, maxIterations, work.potential);
    displaceFaces(grid, obstacles, pressure, work);
    return report;
}

}  // namespace sim
