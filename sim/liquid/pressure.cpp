#include "sim/liquid/pressure.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

namespace sim {

namespace {

/// Bits of the cells of a block, and of their neighbours below along each axis.
struct NeighbourBits {
    std::uint64_t own[kBlockEdge], below[kAxes][kBlockEdge];
    NeighbourBits(const BlockGrid& grid, const BlockBits<>& bits, int block)
    {
        const BitAccess access(grid, block);
        for (int k = 0; k < kBlockEdge; ++k) {
            own[k] = bits.block(block)[k];
            for (int a = 0; a < kAxes; ++a) below[a][k] = access.below(bits, 0, a, k);
        }
    }
};

/// k_f of every lower face beside a liquid cell: zero where it is closed or carries no liquid. Faces between deep cells are full: what P2G
/// found there differs from that by the noise of the particles' places only.
/// @param full  so are faces without particles
void computeCoefficients(const CutGrid& cut, double scale, bool full, const LiquidGrid& liquid, PressureWorkspace& work)
{
    work.coefficient.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const NeighbourBits inside(cut.grid, liquid.inside, b), deep(cut.grid, liquid.deep, b);
        for (int a = 0; a < kAxes; ++a)
            for (int k = 0; k < kBlockEdge; ++k)
                for (int j = 0; j < kBlockEdge; ++j) {
                    const int row = cellInBlock(0, j, k);
                    const Pack open = loadPack(cut.field.open(b, a) + row), room = liquid.fullMass * loadPack(cut.field.room(b, a) + row);
                    const PackMask wet = rowBits(liquid.wet.block(b, a), j, k);
                    const PackMask isFull = (rowBits(deep.own, j, k) & rowBits(deep.below[a], j, k)) | (full ? ~wet : PackMask{});
                    const Pack mass = select(isFull, room, loadPack(liquid.faces.sums.block(b, FaceFields::kMass + a) + row));
                    const PackMask counts = (rowBits(inside.own, j, k) | rowBits(inside.below[a], j, k)) & (wet | isFull);
                    const PackMask known = counts & (open > 0.0) & (room > 0.0);
                    const Pack value = select(known, scale * open * room / maxPack(mass, kLeastFill * room), broadcast(0.0));
                    std::memcpy(work.coefficient.block(b, a) + row, &value, sizeof value);
                }
    });
}

/// ω u and what solids sweep through the faces of a row that lie below or above its cells.
struct RowFlux {
    const ObstacleField& obstacles;
    const BlockArray<double, 3>& velocity;
    const RowAccess& rows;
    int axis;

    Pack through(int block, int row) const
    {
        const Pack open = loadPack(obstacles.open(block, axis) + row), u = loadPack(velocity.block(block, axis) + row);
        return open * u + loadPack(obstacles.swept(block, axis) + row);
    }
    Pack below(int j, int k) const { return through(rows.neighbours[kBlockItself], cellInBlock(0, j, k)); }
    Pack above(int j, int k) const
    {
        if (axis == 0) return shiftLeft(below(j, k), through(rows.neighbours[neighbourIndex(1, 0, 0)], cellInBlock(0, j, k)));
        const int uj = j + (axis == 1), uk = k + (axis == 2);
        return through(rows.neighbours[neighbourIndex(0, uj >> 3, uk >> 3)], cellInBlock(0, uj & 7, uk & 7));
    }
};

/// Net outflow of the cells of row (j, k), per cell face area [cm/s].
[[gnu::always_inline]] inline Pack rowOutflow(const ObstacleField& obstacles, const BlockArray<double, 3>& velocity, const RowAccess& rows, int j,
                                              int k)
{
    Pack out = broadcast(0.0);
    for (int a = 0; a < kAxes; ++a) {
        const RowFlux flux{obstacles, velocity, rows, a};
        out += flux.above(j, k) - flux.below(j, k);
    }
    return out;
}

/// Rows of the matrix for one block (liquid/README.md, Pressure).
void assembleBlock(const BlockGrid& grid, int b, const LiquidGrid& liquid, PressureWorkspace& work)
{
    const RowAccess rows(grid, b);
    const NeighbourBits inside(grid, liquid.inside, b);
    const Pack zero = broadcast(0.0);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j) {
            const int row = cellInBlock(0, j, k);
            const PackMask own = rowBits(inside.own, j, k);
            Pack diagonal = zero, coupling[3] = {zero, zero, zero};
            if (maskBits(own) != 0) {
                unroll<3>([&](auto a) {
                    const Pack below = rows.row(work.coefficient, a, j, k);
                    diagonal += below + rows.above(work.coefficient, a, a, j, k);
                    coupling[a] = select(own & rowBits(inside.below[a], j, k), below, zero);
                });
                diagonal = select(own, diagonal, zero);
            }
            std::memcpy(work.matrix.diagonal(b) + row, &diagonal, sizeof diagonal);
            for (int a = 0; a < kAxes; ++a) std::memcpy(work.matrix.coupling(a, b) + row, &coupling[a], sizeof coupling[a]);
        }
}

void addInflow(std::span<const InflowCell> inflow, BlockArray<double>& rhs)
{
    for (const InflowCell& c : inflow) rhs.block(c.block)[c.cell] += c.rate;
}

}  // namespace

PressureMatrix::PressureMatrix(const PressureFaces& faces, const BlockGrid& grid) : PressureFaces(faces)
{
    work_->matrix.resize(grid.count());
    parallelFor(grid.count(), [&](std::size_t b) { assembleBlock(grid, static_cast<int>(b), liquid(), *work_); });
}

PressureComponents::PressureComponents(const PressureMatrix& matrix, const BlockGrid& grid) : PressureMatrix(matrix)
{
    work_->solver.findComponents(grid, work_->matrix);
}

PressureSystem::PressureSystem(const PressureComponents& components, const BlockGrid& grid) : PressureComponents(components)
{
    work_->solver.buildHierarchy(grid, work_->matrix);
}

SolveReport PressureSystem::solve(const BlockGrid& grid, SolveTolerance tolerance, int maxIterations, BlockArray<double>& potential) const
{
    return work_->solver.solveAgain(grid, work_->matrix, work_->rhs, tolerance, maxIterations, potential);
}

PressureFaces findPressureFaces(const CutGrid& cut, const LiquidSettings& settings, double dt, const SurfaceCells& cells, PressureWorkspace& work)
{
    work.ofFull = dt / (settings.density * cut.grid.dx * cut.grid.dx);
    computeCoefficients(cut, work.ofFull, settings.full, cells.liquid(), work);
    return PressureFaces(cells, work);
}

PressureMatrix assembleMatrix(const PressureFaces& faces, const BlockGrid& grid) { return PressureMatrix(faces, grid); }

PressureComponents findComponents(const PressureMatrix& matrix, const BlockGrid& grid) { return PressureComponents(matrix, grid); }

PressureSystem buildHierarchy(const PressureMatrix&, const PressureComponents& components, const BlockGrid& grid)
{
    return PressureSystem(components, grid);
}

PressureSystem preparePressure(const PressureFaces& faces, const BlockGrid& grid)
{
    const PressureComponents components = findComponents(assembleMatrix(faces, grid), grid);
    return buildHierarchy(components, components, grid);
}

void subtractGradient(const CutGrid& cut, const PressureFaces& faces, const BlockArray<double>& pressure, LiquidGrid& liquid)
{
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            std::uint64_t* valid = liquid.faces.valid.block(b, a);
            for (int k = 0; k < kBlockEdge; ++k) valid[k] = liquid.wet.block(b, a)[k] & ~cut.field.closed(b, a)[k];
            forEachPressureFace(cut, faces, pressure, b, a, [&](int row, PackMask known, Pack change) {
                valid[row >> 6] |= static_cast<std::uint64_t>(maskBits(known)) << (row & 63);
                double* velocity = liquid.faces.velocity.block(b, a) + row;
                const Pack moved = loadPack(velocity) + change;
                std::memcpy(velocity, &moved, sizeof moved);
            });
        }
    });
}

SolveReport solvePressure(const CutGrid& cut, const SolverSettings& solver, std::span<const InflowCell> inflow, const PressureSystem& system,
                          LiquidGrid& liquid, BlockArray<double>& pressure)
{
    findRightHandSide(cut, system, liquid.faces.velocity, inflow, system.rightHandSide());
    const SolveReport report = system.solve(cut.grid, solver.pressureTolerance, solver.maxIterations, pressure);
    subtractGradient(cut, system, pressure, liquid);
    return report;
}

void findRightHandSide(const CutGrid& cut, const LiquidCells& cells, const BlockArray<double, 3>& velocity, std::span<const InflowCell> inflow,
                       BlockArray<double>& rhs)
{
    const BlockBits<>& inside = cells.liquid().inside;
    rhs.resize(cut.grid.count());
    parallelFor(cut.grid.count(), 2, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const RowAccess rows(cut.grid, b);
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const PackMask own = rowBits(inside.block(b), j, k);
                Pack out = broadcast(0.0);
                if (maskBits(own) != 0) out = select(own, rowOutflow(cut.field, velocity, rows, j, k) * (-1.0 / cut.grid.dx), out);
                storePack(rhs.block(b) + cellInBlock(0, j, k), out);
            }
    });
    addInflow(inflow, rhs);
}

void addPressure(double share, const BlockArray<double>& more, const BlockGrid& grid, BlockArray<double>& pressure)
{
    parallelFor(grid.count(), 8, [&](std::size_t b) {
        double* sum = pressure.block(static_cast<int>(b));
        const double* added = more.block(static_cast<int>(b));
        for (int i = 0; i < kBlockCells; ++i) sum[i] += share * added[i];
    });
}

double largestDivergence(const CutGrid& cut, const LiquidGrid& liquid)
{
    return parallelMax(cut.grid.count(), [&](std::size_t n) {
        const RowAccess rows(cut.grid, static_cast<int>(n));
        double largest = 0.0;
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const PackMask inside = rowBits(liquid.inside.block(static_cast<int>(n)), j, k);
                const Pack out = absPack(select(inside, rowOutflow(cut.field, liquid.faces.velocity, rows, j, k), broadcast(0.0)));
                for (int l = 0; l < kLanes; ++l) largest = std::max(largest, out[l] / cut.grid.dx);
            }
        return largest;
    });
}

}  // namespace sim
