#include "sim/liquid/pressure.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

namespace sim {

namespace {

/// Distance to the surface as a fraction of the distance between the cells: from a liquid cell (phi < 0) to an air cell.
[[gnu::always_inline]] inline Pack surfaceFraction(Pack phiLiquid, Pack phiAir)
{
    return maxPack(phiLiquid / (phiLiquid - phiAir), broadcast(kThinnest));
}

/// k_f of every lower face: zero where it is closed or carries no liquid.
void computeCoefficients(const BlockGrid& grid, const ObstacleField& obstacles, double scale, bool full, const LiquidGrid& liquid,
                         PressureWorkspace& work)
{
    work.coefficient.resize(grid.count());
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            const double* open = obstacles.open(b, a);
            const std::uint64_t* wet = liquid.wet.block(b, a);
            double* k = work.coefficient.block(b, a);
            for (int row = 0; row < kBlockCells; row += kLanes) {
                const PackMask carries = full ? maskOfBits(0xff) : maskOfBits(wet[row >> 6] >> (row & 63));
                const Pack value = select(carries, scale * loadPack(open + row), broadcast(0.0));
                std::memcpy(k + row, &value, sizeof value);
            }
        }
    });
}

/// ω u + (1 − ω) v_S through the faces of a row that lie below or above its cells.
struct RowFlux {
    const ObstacleField& obstacles;
    const LiquidGrid& liquid;
    const RowAccess& rows;
    int axis;

    Pack through(int block, int row) const
    {
        const Pack open = loadPack(obstacles.open(block, axis) + row), wall = loadPack(obstacles.wallVelocity(block, axis) + row);
        const Pack u = loadPack(liquid.faces.velocity.block(block, axis) + row);
        return open * u + (1.0 - open) * wall;
    }
    Pack below(int j, int k) const { return through(rows.neighbours[13], cellInBlock(0, j, k)); }
    Pack above(int j, int k) const
    {
        if (axis == 0) return shiftLeft(below(j, k), through(rows.neighbours[neighbourIndex(1, 0, 0)], cellInBlock(0, j, k)));
        const int uj = j + (axis == 1), uk = k + (axis == 2);
        return through(rows.neighbours[neighbourIndex(0, uj >> 3, uk >> 3)], cellInBlock(0, uj & 7, uk & 7));
    }
};

/// Net outflow of the cells of row (j, k), per cell face area [cm/s].
[[gnu::always_inline]] inline Pack rowOutflow(const ObstacleField& obstacles, const LiquidGrid& liquid, const RowAccess& rows, int j, int k)
{
    Pack out = broadcast(0.0);
    for (int a = 0; a < kAxes; ++a) {
        const RowFlux flux{obstacles, liquid, rows, a};
        out += flux.above(j, k) - flux.below(j, k);
    }
    return out;
}

/// Rows of the matrix and the right-hand side for one block (model-fluid 6.4).
void assembleBlock(const BlockGrid& grid, const ObstacleField& obstacles, int b, const LiquidGrid& liquid, PressureWorkspace& work)
{
    const RowAccess rows(grid, b);
    const Pack zero = broadcast(0.0);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j) {
            const int row = cellInBlock(0, j, k);
            const Pack phi = rows.row(liquid.levelSet, 0, j, k);
            const PackMask inside = phi < 0.0;
            Pack diagonal = zero, rhs = zero, coupling[3] = {zero, zero, zero};
            if (maskBits(inside) != 0) {
                const auto add = [&](Pack coefficient, Pack phiOther) {
                    const PackMask both = phiOther < 0.0;
                    diagonal += select(both, coefficient, coefficient / surfaceFraction(phi, phiOther));
                    return select(both & inside, coefficient, zero);
                };
                unroll<3>([&](auto a) {
                    coupling[a] = add(rows.row(work.coefficient, a, j, k), rows.below(liquid.levelSet, 0, a, j, k));
                    add(rows.above(work.coefficient, a, a, j, k), rows.above(liquid.levelSet, 0, a, j, k));
                });
                diagonal = select(inside, diagonal, zero);
                rhs = select(inside, rowOutflow(obstacles, liquid, rows, j, k) * (-1.0 / grid.dx), zero);
            }
            std::memcpy(work.matrix.diagonal(b) + row, &diagonal, sizeof diagonal);
            std::memcpy(work.rhs.block(b) + row, &rhs, sizeof rhs);
            for (int a = 0; a < kAxes; ++a) std::memcpy(work.matrix.coupling(a, b) + row, &coupling[a], sizeof coupling[a]);
        }
}

/// u −= (dt/ρ) grad p on the faces of the system: those with a coefficient, beside at least one liquid cell. They become the valid ones.
void subtractGradient(const BlockGrid& grid, const BlockArray<double, 3>& coefficient, double scale, const BlockArray<double>& pressure,
                      LiquidGrid& liquid)
{
    parallelFor(grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(grid, b);
        for (int a = 0; a < kAxes; ++a) {
            std::uint64_t* valid = liquid.faces.valid.block(b, a);
            std::fill_n(valid, BlockBits<3>::kWords, 0);
            for (int k = 0; k < kBlockEdge; ++k)
                for (int j = 0; j < kBlockEdge; ++j) {
                    const Pack phi = rows.row(liquid.levelSet, 0, j, k), phiBelow = rows.below(liquid.levelSet, 0, a, j, k);
                    const PackMask inside = phi < 0.0, insideBelow = phiBelow < 0.0;
                    const int row = cellInBlock(0, j, k);
                    const PackMask known = (inside | insideBelow) & (loadPack(coefficient.block(b, a) + row) > 0.0);
                    const unsigned bits = maskBits(known);
                    if (bits == 0) continue;
                    valid[row >> 6] |= static_cast<std::uint64_t>(bits) << (row & 63);
                    const Pack p = rows.row(pressure, 0, j, k), pBelow = rows.below(pressure, 0, a, j, k);
                    const Pack fraction = select(inside & insideBelow, broadcast(1.0),
                                                 select(inside, surfaceFraction(phi, phiBelow), surfaceFraction(phiBelow, phi)));
                    double* velocity = liquid.faces.velocity.block(b, a) + row;
                    const Pack u = loadPack(velocity), moved = select(known, u - scale * (p - pBelow) / fraction, u);
                    std::memcpy(velocity, &moved, sizeof moved);
                }
        }
    });
}

}  // namespace

SolveReport projectPressure(const BlockGrid& grid, const ObstacleField& obstacles, const LiquidSettings& settings, const SolverSettings& solver,
                            double dt, PressureWorkspace& work, LiquidGrid& liquid, BlockArray<double>& pressure)
{
    const double mobility = dt / settings.density;
    work.matrix.resize(grid.count());
    work.rhs.resize(grid.count());
    computeCoefficients(grid, obstacles, mobility / (grid.dx * grid.dx), settings.full, liquid, work);
    parallelFor(grid.count(), [&](std::size_t b) { assembleBlock(grid, obstacles, static_cast<int>(b), liquid, work); });
    const SolveReport report = work.solver.solve(grid, work.matrix, work.rhs, solver.pressureTolerance, solver.maxIterations, pressure);
    subtractGradient(grid, work.coefficient, mobility / grid.dx, pressure, liquid);
    return report;
}

double largestDivergence(const BlockGrid& grid, const ObstacleField& obstacles, const LiquidGrid& liquid)
{
    return parallelMax(grid.count(), [&](std::size_t n) {
        const RowAccess rows(grid, static_cast<int>(n));
        double largest = 0.0;
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const PackMask inside = rows.row(liquid.levelSet, 0, j, k) < 0.0;
                const Pack out = absPack(select(inside, rowOutflow(obstacles, liquid, rows, j, k), broadcast(0.0)));
                for (int l = 0; l < kLanes; ++l) largest = std::max(largest, out[l] / grid.dx);
            }
        return largest;
    });
}

}  // namespace sim
