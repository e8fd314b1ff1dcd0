#include "sim/liquid/surface_tension.h"

#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <bit>
#include <cmath>

namespace sim {

SurfaceSteps findSurfaceSteps(const CutGrid& cut, const LiquidSettings& settings, const SurfaceCells& cells, SurfaceTensionWorkspace& work)
{
    const LiquidGrid& liquid = cells.liquid();
    work.curvature.find(cut, cells, settings.curvatureSmoothing);
    work.step.resize(cut.grid.count());
    parallelFor(static_cast<std::size_t>(cut.grid.count()), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const BitAccess bits(cut.grid, b);
        for (int a = 0; a < kAxes; ++a) {
            double* step = work.step.block(b, a);
            std::fill_n(step, kBlockCells, 0.0);
            for (int k = 0; k < kBlockEdge; ++k) {
                const std::uint64_t above = liquid.inside.block(b)[k];
                std::uint64_t crossed = (above ^ bits.below(liquid.inside, 0, a, k)) & liquid.wet.block(b, a)[k] & ~cut.field.closed(b, a)[k];
                for (; crossed != 0; crossed &= crossed - 1) {
                    const int bit = std::countr_zero(crossed);
                    const Vec3i cell(bit & 7, bit >> 3, k), below = cell - Vec3i::Unit(a);
                    const bool isAbove = above >> bit & 1;
                    const double kappa = isAbove ? work.curvature.between(b, cell, below) : work.curvature.between(b, below, cell);
                    step[cellInBlock(cell.x(), cell.y(), k)] = (isAbove ? -1.0 : 1.0) * settings.surfaceTension * kappa;
                }
            }
        }
    });
    return SurfaceSteps(work);
}

void applySurfaceSteps(const CutGrid& cut, const PressureFaces& faces, double share, const SurfaceSteps& steps, LiquidGrid& liquid)
{
    parallelFor(static_cast<std::size_t>(cut.grid.count()), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a)
            for (int row = 0; row < kBlockCells; row += kLanes) {
                const Pack step = loadPack(steps.step().block(b, a) + row), coefficient = loadPack(faces.coefficient().block(b, a) + row);
                const PackMask acts = (step != 0.0) & (coefficient > 0.0);
                if (maskBits(acts) == 0) continue;
                const Pack change = -cut.grid.dx * share * coefficient / loadPack(cut.field.open(b, a) + row) * step;
                double* velocity = liquid.faces.velocity.block(b, a) + row;
                storePack(velocity, loadPack(velocity) + select(acts, change, broadcast(0.0)));
            }
    });
}

double capillaryTimeStep(const LiquidSettings& settings, double cell)
{
    return std::sqrt(settings.density * cell * cell * cell / (4.0 * kPi * settings.surfaceTension));
}

}  // namespace sim
