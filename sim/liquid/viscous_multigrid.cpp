#include "sim/liquid/viscous_multigrid.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/solvers/block_rows.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// No eigenvalue of the matrix over its diagonal is larger: a strain has at most four velocities.
constexpr double kLargest = 4.0;
constexpr double kSmoothed = 0.4;  ///< the smallest that smoothing takes care of where there is a coarser level
constexpr int kSmoothingSteps = 3;
constexpr double kStiff = 0.5;      ///< levels stiffer than this get a coarser one
constexpr double kSmallest = 0.04;  ///< that the coarsest level takes care of at most

/// Weights of the velocities of coarse faces in that of a fine one, along one axis: at(0) with weight(0), at(1) with
/// weight(1).
struct Interpolation {
    int at[2];
    double weight[2];

    /// @param isNormal  faces stand across this axis: every second one is on a coarse face; else in the middles of
    /// cells
    Interpolation(int fine, bool isNormal)
    {
        const bool isOdd = (fine & 1) != 0;
        at[0] = fine >> 1;
        at[1] = isNormal || isOdd ? at[0] + 1 : at[0] - 1;
        weight[1] = isNormal ? (isOdd ? 0.5 : 0.0) : 0.25;
        weight[0] = 1.0 - weight[1];
    }
};

/// The other way, along one axis: the fine places around a coarse one, from `first` on, with their weights in it.
/// Velocities stand on faces across the axis or in the middles of cells along it; so do strains, but for those whose
/// velocities differ along it: there a coarse one is that of its two halves.
struct Gathering {
    enum Kind { kAcross, kMiddle, kHalves };
    int first, count;
    std::array<double, 4> weight;

    Gathering(int coarse, Kind kind)
        : first(2 * coarse - (kind == kHalves ? 0 : 1)), count(kCount[kind]), weight(kWeight[kind])
    {
    }

 private:
    static constexpr int kCount[3] = {3, 4, 2};
    static constexpr std::array<double, 4> kWeight[3] = {
        {0.5, 1.0, 0.5, 0.0}, {0.25, 0.75, 0.75, 0.25}, {1.0, 1.0, 0.0, 0.0}};
};

Vec3i parentOf(const Vec3i& coords)
{
    return coords.unaryExpr([](int v) { return v >> 1; });
}

/// Where cell (i, j, k) of the finer level is, counted from the first cell of a coarse block, each −8 … 23.
CellRef fineCell(const std::array<int, 64>& below, int i, int j, int k)
{
    return {below[((k >> 3) + 1) * 16 + ((j >> 3) + 1) * 4 + (i >> 3) + 1], cellInBlock(i & 7, j & 7, k & 7)};
}

/// Σ weight × value over the fine places around a coarse one: `own` along the axis, `others` along the other two.
double gather(const std::array<int, 64>& below, const BlockArray<double, 3>& fine, int axis, const Vec3i& coarse,
              Gathering::Kind own, Gathering::Kind others)
{
    const auto along = [&](int a) { return Gathering(coarse[a], a == axis ? own : others); };
    const Gathering x = along(0), y = along(1), z = along(2);
    double sum = 0.0;
    for (int k = 0; k < z.count; ++k)
        for (int j = 0; j < y.count; ++j) {
            const CellRef first = fineCell(below, x.first, y.first + j, z.first + k);
            const double* values = fine.block(first.block, axis) + first.cell;
            double row = 0.0;
            for (int i = 0; i < x.count; ++i) {
                if (i > 0 && ((x.first + i) & 7) == 0) {
                    const CellRef next = fineCell(below, x.first + i, y.first + j, z.first + k);
                    values = fine.block(next.block, axis) + next.cell - i;
                }
                row += x.weight[i] * values[i];
            }
            sum += y.weight[j] * z.weight[k] * row;
        }
    return sum;
}

/// The velocity of a coarse face stands for these.
double gatherFaces(const std::array<int, 64>& below, const BlockArray<double, 3>& fine, int axis, const Vec3i& coarse)
{
    return gather(below, fine, axis, coarse, Gathering::kAcross, Gathering::kMiddle);
}

/// body(axis, cell, index of the cell) for all faces of a block.
template <class Body>
void forEachFace(Body&& body)
{
    for (int a = 0; a < kAxes; ++a)
        for (int c = 0; c < kBlockCells; ++c) body(a, Vec3i(c & 7, c >> 3 & 7, c >> 6), c);
}

/// Part of the diagonal that no coupling to another unknown velocity stands against: inertia and walls.
void findAnchor(const BlockGrid& grid, const ViscousSystem& system, int b, BlockArray<double, 3>& anchor)
{
    const RowAccess rows(grid, b);
    const BitAccess bits(grid, b);
    for (int a = 0; a < kAxes; ++a) {
        std::fill_n(anchor.block(b, a), kBlockCells, 0.0);
        forEachRow(system.rowsOf(b, a), [&](int r) {
            const int j = r % kBlockEdge, k = r / kBlockEdge;
            const auto known = [&](std::uint64_t word) { return maskOfBits(word >> (j * kBlockEdge)); };
            const Pack zero = broadcast(0.0), own = rows.row(system.normal, a, j, k),
                       lower = rows.below(system.normal, a, a, j, k);
            Pack sum = rows.row(system.diagonal, a, j, k);
            sum -= select(known(bits.above(system.unknown, a, a, k)), own, zero) +
                   select(known(bits.below(system.unknown, a, a, k)), lower, zero);
            for (int side = 1; side < kAxes; ++side) {
                const int along = (a + side) % 3, edge = (a + 3 - side) % 3;
                sum -= rows.row(system.shear, edge, j, k) + rows.above(system.shear, edge, along, j, k);
            }
            storePack(anchor.block(b, a) + r * kBlockEdge,
                      select(known(system.unknown.block(b, a)[k]), maxPack(sum, zero), zero));
        });
    }
}

/// Volumes of strains, over dx². A fine strain goes to the coarse ones whose mean it is, so that the coarse system
/// never takes a motion for less stiff than it is: corrections do not overshoot at the liquid's edge.
void coarsenStrains(const ViscousSystem& fine, const std::array<int, 64>& below, int b, ViscousSystem& coarse)
{
    forEachFace([&](int a, const Vec3i& cell, int c) {
        coarse.normal.block(b, a)[c] =
            0.25 * gather(below, fine.normal, a, cell, Gathering::kHalves, Gathering::kMiddle);
        coarse.shear.block(b, a)[c] = 0.25 * gather(below, fine.shear, a, cell, Gathering::kMiddle, Gathering::kAcross);
    });
}

/// Diagonal from the anchor that stands in its place, and with it the unknowns.
void finishDiagonal(const BlockGrid& grid, int b, ViscousSystem& system)
{
    const RowAccess rows(grid, b);
    for (int a = 0; a < kAxes; ++a) {
        std::uint64_t* unknown = system.unknown.block(b, a);
        std::fill_n(unknown, BlockBits<3>::kWords, 0);
        std::uint64_t used = 0;
        for (int r = 0; r < kBlockRows; ++r) {
            const int j = r % kBlockEdge, k = r / kBlockEdge;
            double* diagonal = system.diagonal.block(b, a) + r * kBlockEdge;
            const Pack anchor = loadPack(diagonal);
            const PackMask is = anchor > 0.0;
            if (maskBits(is) == 0) continue;
            Pack sum = anchor + rows.row(system.normal, a, j, k) + rows.below(system.normal, a, a, j, k);
            for (int side = 1; side < kAxes; ++side) {
                const int along = (a + side) % 3, edge = (a + 3 - side) % 3;
                sum += rows.row(system.shear, edge, j, k) + rows.above(system.shear, edge, along, j, k);
            }
            storePack(diagonal, select(is, sum, broadcast(0.0)));
            unknown[k] |= static_cast<std::uint64_t>(maskBits(is)) << (j * kBlockEdge);
            used |= std::uint64_t{1} << r;
        }
        system.rows[static_cast<std::size_t>(b) * kAxes + a] = used;
    }
}

template <class Body>
void forEachUnknownRow(const ViscousSystem& system, int b, Body&& body)
{
    for (int a = 0; a < kAxes; ++a) forEachRow(system.rowsOf(b, a), [&](int r) { body(a, r * kBlockEdge); });
}

}  // namespace

/// Which blocks of the two levels belong together.
void ViscousMultigrid::connect(Level& fine, Level& coarse)
{
    fine.parent.resize(fine.grid->count());
    for (int b = 0; b < fine.grid->count(); ++b) fine.parent[b] = coarse.grid->find(parentOf(fine.grid->coords(b)));
    coarse.below.resize(coarse.grid->count());
    for (int b = 0; b < coarse.grid->count(); ++b)
        for (int n = 0; n < 64; ++n) {
            const int found =
                fine.grid->find(2 * coarse.grid->coords(b) + Vec3i((n & 3) - 1, (n >> 2 & 3) - 1, (n >> 4) - 1));
            coarse.below[b][n] = found == BlockGrid::kNone ? fine.grid->count() : found;
        }
}

/// Each level to its grid: levels may have been moved or copied.
void ViscousMultigrid::point(const BlockGrid& grid)
{
    for (Level& level : levels_) level.grid = &level == &levels_[0] ? &grid : &level.ownGrid;
}

void ViscousMultigrid::buildShape(const BlockGrid& grid)
{
    coords_ = grid.coords();
    if (levels_.empty()) levels_.resize(1);
    std::vector<Vec3i> coords = coords_;
    std::size_t l = 0;
    // Blocks on either side of a coordinate plane never share a parent.
    const auto isLast = [](const Vec3i& c) { return c.minCoeff() >= -1 && c.maxCoeff() <= 0; };
    for (; coords.size() > 1 && !std::ranges::all_of(coords, isLast); ++l) {
        for (Vec3i& c : coords) c = parentOf(c);
        const auto before = [](const Vec3i& a, const Vec3i& b) {
            return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
        };
        std::sort(coords.begin(), coords.end(), before);
        coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
        if (l + 1 == levels_.size()) levels_.emplace_back();
        levels_[l + 1].ownGrid.setBlocks(coords);
    }
    levels_.resize(l + 1);
    point(grid);
    for (std::size_t n = 1; n < levels_.size(); ++n) connect(levels_[n - 1], levels_[n]);
}

void ViscousMultigrid::coarsen(const Level& fine, Level& coarse)
{
    const int blocks = coarse.grid->count();
    ViscousSystem& system = coarse.ownSystem;
    system.unknown.resize(blocks);
    system.rows.resize(static_cast<std::size_t>(blocks) * kAxes);
    for (BlockArray<double, 3>* field : {&system.diagonal, &system.normal, &system.shear, &coarse.rhs})
        field->resize(blocks);
    coarse.system = &system;
    parallelFor(blocks, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        coarsenStrains(*fine.system, coarse.below[b], b, system);
        forEachFace([&](int a, const Vec3i& cell, int c) {
            system.diagonal.block(b, a)[c] = gatherFaces(coarse.below[b], fine.residual, a, cell);
        });
    });
    parallelFor(blocks, [&](std::size_t b) { finishDiagonal(*coarse.grid, static_cast<int>(b), system); });
}

void ViscousMultigrid::build(const BlockGrid& grid, const ViscousSystem& system, double stiffness)
{
    if (levels_.empty() || coords_ != grid.coords()) buildShape(grid);
    point(grid);
    levels_[0].system = &system;
    stiffness_ = stiffness;
    count_ = 1;
    for (double s = stiffness; s > kStiff && count_ < static_cast<int>(levels_.size()); s *= 0.25) ++count_;
    for (int l = 0; l < count_; ++l) {
        Level& level = levels_[l];
        const int blocks = level.grid->count();
        for (BlockArray<double, 3>* v : {&level.solution, &level.residual, &level.direction, &level.applied})
            v->resize(blocks);
        if (l + 1 == count_) break;
        forEachBlock(blocks, [&](int b) { findAnchor(*level.grid, *level.system, b, level.residual); });
        coarsen(level, levels_[l + 1]);
    }
    for (int l = 0; l < count_; ++l)
        for (BlockArray<double, 3>* v : {&levels_[l].solution, &levels_[l].residual, &levels_[l].direction})
            forEachBlock(levels_[l].grid->count(),
                         [&](int b) { std::fill_n(v->block(b), BlockArray<double, 3>::kStride, 0.0); });
}

/// Chebyshev's iteration for eigenvalues from `lowest` to kLargest (Saad 2003, algorithm 12.1). Leaves the residual
/// behind.
void ViscousMultigrid::smooth(Level& level, const BlockArray<double, 3>& rhs, double lowest, int steps, bool fromZero)
{
    const BlockGrid& grid = *level.grid;
    const ViscousSystem& system = *level.system;
    const double middle = 0.5 * (kLargest + lowest), half = 0.5 * (kLargest - lowest);
    if (!fromZero) forEachBlock(grid.count(), [&](int b) { system.multiply(grid, level.solution, b, level.applied); });
    double ratio = half / middle;
    for (int step = 0; step <= steps; ++step) {
        const double next = 1.0 / (2.0 * middle / half - ratio);
        const double keep = step == 0 ? 0.0 : next * ratio, take = step == 0 ? 1.0 / middle : 2.0 * next / half;
        if (step > 0) {
            forEachBlock(grid.count(), [&](int b) { system.multiply(grid, level.direction, b, level.applied); });
            ratio = next;
        }
        forEachBlock(grid.count(), [&](int b) {
            forEachUnknownRow(system, b, [&](int a, int row) {
                double *x = level.solution.block(b, a) + row, *r = level.residual.block(b, a) + row;
                double* d = level.direction.block(b, a) + row;
                const bool isFresh = step == 0;
                Pack residual = loadPack(isFresh ? rhs.block(b, a) + row : r);
                if (!isFresh || !fromZero) residual -= loadPack(level.applied.block(b, a) + row);
                storePack(r, residual);
                if (step == steps) return;
                const Pack diagonal = loadPack(system.diagonal.block(b, a) + row);
                Pack move = take * select(diagonal > 0.0, residual / diagonal, broadcast(0.0));
                if (!isFresh) move += keep * loadPack(d);
                storePack(d, move);
                storePack(x, isFresh && fromZero ? move : loadPack(x) + move);
            });
        });
    }
}

void ViscousMultigrid::restrict(const Level& fine, Level& coarse)
{
    parallelFor(coarse.grid->count(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            std::fill_n(coarse.rhs.block(b, a), kBlockCells, 0.0);
            forEachRow(coarse.system->rowsOf(b, a), [&](int r) {
                for (int i = 0; i < kBlockEdge; ++i) {
                    const int c = r * kBlockEdge + i;
                    if (!coarse.system->unknown.test(b, c, a)) continue;
                    coarse.rhs.block(b, a)[c] =
                        gatherFaces(coarse.below[b], fine.residual, a, Vec3i(i, r % kBlockEdge, r / kBlockEdge));
                }
            });
        }
    });
}

void ViscousMultigrid::prolong(const Level& coarse, Level& fine)
{
    forEachBlock(fine.grid->count(), [&](int b) {
        const int parent = fine.parent[b];
        const Vec3i first = 4 * fine.grid->coords(b).unaryExpr([](int v) { return v & 1; });
        forEachUnknownRow(*fine.system, b, [&](int a, int row) {
            const int j = row / kBlockEdge % kBlockEdge, k = row / kBlockRows;
            const Interpolation y(j, a == 1), z(k, a == 2);
            for (int i = 0; i < kBlockEdge; ++i) {
                if (!fine.system->unknown.test(b, row + i, a)) continue;
                const Interpolation x(i, a == 0);
                double sum = 0.0;
                for (int n = 0; n < 8; ++n) {
                    const double weight = x.weight[n & 1] * y.weight[n >> 1 & 1] * z.weight[n >> 2];
                    const CellRef from = cellNear(*coarse.grid, parent, first.x() + x.at[n & 1],
                                                  first.y() + y.at[n >> 1 & 1], first.z() + z.at[n >> 2]);
                    sum += weight * coarse.solution.block(from.block, a)[from.cell];
                }
                fine.solution.block(b, a)[row + i] += sum;
            }
        });
    });
}

void ViscousMultigrid::cycle(int l, const BlockArray<double, 3>& rhs)
{
    Level& level = levels_[l];
    if (l + 1 == count_) {
        // Without a coarser level the smallest eigenvalue is inertia's share of the diagonal.
        const double lowest = std::max(kSmallest, 1.0 / (1.0 + 8.0 * stiffness_ * std::pow(0.25, l)));
        smooth(level, rhs, lowest, static_cast<int>(std::ceil(std::sqrt(kLargest / lowest))), true);
        return;
    }
    Level& coarse = levels_[l + 1];
    smooth(level, rhs, kSmoothed, kSmoothingSteps, true);
    restrict(level, coarse);
    cycle(l + 1, coarse.rhs);
    prolong(coarse, level);
    smooth(level, rhs, kSmoothed, kSmoothingSteps, false);
}

}  // namespace sim
