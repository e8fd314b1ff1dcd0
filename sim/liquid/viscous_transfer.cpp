#include "sim/liquid/viscous_transfer.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"
#include "sim/solvers/block_rows.h"

namespace sim {

namespace {

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

    Gathering(int coarse, Kind kind) : first(2 * coarse - (kind == kHalves ? 0 : 1)), count(kCount[kind]), weight(kWeight[kind]) {}

 private:
    static constexpr int kCount[3] = {3, 4, 2};
    static constexpr std::array<double, 4> kWeight[3] = {{0.5, 1.0, 0.5, 0.0}, {0.25, 0.75, 0.75, 0.25}, {1.0, 1.0, 0.0, 0.0}};
};

/// Where cell (i, j, k) of the finer level is, counted from the first cell of a coarse block, each −8 … 23.
CellRef fineCell(const std::array<int, 64>& below, int i, int j, int k)
{
    return {below[((k >> 3) + 1) * 16 + ((j >> 3) + 1) * 4 + (i >> 3) + 1], cellInBlock(i & 7, j & 7, k & 7)};
}

/// Σ weight × value over the fine places around a coarse one: `own` along the axis, `others` along the other two.
double gather(const std::array<int, 64>& below, const BlockArray<double, 3>& fine, int axis, const Vec3i& coarse, Gathering::Kind own,
              Gathering::Kind others)
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
            const auto known = [&](std::uint64_t word) { return rowBits(word, j); };
            const Pack zero = broadcast(0.0), own = rows.row(system.normal, a, j, k), lower = rows.below(system.normal, a, a, j, k);
            Pack sum = rows.row(system.diagonal, a, j, k);
            sum -= select(known(bits.above(system.unknown, a, a, k)), own, zero) + select(known(bits.below(system.unknown, a, a, k)), lower, zero);
            for (int side = 1; side < kAxes; ++side) {
                const int along = (a + side) % 3, edge = (a + 3 - side) % 3;
                sum -= rows.row(system.shear, edge, j, k) + rows.above(system.shear, edge, along, j, k);
            }
            storePack(anchor.block(b, a) + r * kBlockEdge, select(known(system.unknown.block(b, a)[k]), maxPack(sum, zero), zero));
        });
    }
}

/// Volumes of strains, over dx². A fine strain goes to the coarse ones whose mean it is, so that the coarse system
/// never takes a motion for less stiff than it is: corrections do not overshoot at the liquid's edge.
void coarsenStrains(const ViscousSystem& fine, const std::array<int, 64>& below, int b, ViscousSystem& coarse)
{
    forEachFace([&](int a, const Vec3i& cell, int c) {
        coarse.normal.block(b, a)[c] = 0.25 * gather(below, fine.normal, a, cell, Gathering::kHalves, Gathering::kMiddle);
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

}  // namespace

void ViscousTransfer::connect(const BlockGrid& fine, const BlockGrid& coarse)
{
    parent_.resize(fine.count());
    for (int b = 0; b < fine.count(); ++b) parent_[b] = coarse.find(parentBlock(fine.coords(b)));
    below_.resize(coarse.count());
    for (int b = 0; b < coarse.count(); ++b)
        for (int n = 0; n < 64; ++n) {
            const int found = fine.find(2 * coarse.coords(b) + Vec3i((n & 3) - 1, (n >> 2 & 3) - 1, (n >> 4) - 1));
            below_[b][n] = found == BlockGrid::kNone ? fine.count() : found;
        }
}

void ViscousTransfer::coarsen(const BlockGrid& fineGrid, const ViscousSystem& fine, BlockArray<double, 3>& scratch, const BlockGrid& coarseGrid,
                              ViscousSystem& coarse) const
{
    const int blocks = coarseGrid.count();
    coarse.unknown.resize(blocks);
    coarse.rows.resize(static_cast<std::size_t>(blocks) * kAxes);
    for (BlockArray<double, 3>* field : {&coarse.diagonal, &coarse.normal, &coarse.shear}) field->resize(blocks);
    forEachBlock(fineGrid.count(), [&](int b) { findAnchor(fineGrid, fine, b, scratch); });
    parallelFor(blocks, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        coarsenStrains(fine, below_[b], b, coarse);
        forEachFace([&](int a, const Vec3i& cell, int c) { coarse.diagonal.block(b, a)[c] = gatherFaces(below_[b], scratch, a, cell); });
    });
    parallelFor(blocks, [&](std::size_t b) { finishDiagonal(coarseGrid, static_cast<int>(b), coarse); });
}

void ViscousTransfer::restrict(const BlockArray<double, 3>& residual, const ViscousSystem& coarse, BlockArray<double, 3>& rhs) const
{
    parallelFor(below_.size(), [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int a = 0; a < kAxes; ++a) {
            std::fill_n(rhs.block(b, a), kBlockCells, 0.0);
            forEachRow(coarse.rowsOf(b, a), [&](int r) {
                for (int i = 0; i < kBlockEdge; ++i) {
                    const int c = r * kBlockEdge + i;
                    if (!coarse.unknown.test(b, c, a)) continue;
                    rhs.block(b, a)[c] = gatherFaces(below_[b], residual, a, Vec3i(i, r % kBlockEdge, r / kBlockEdge));
                }
            });
        }
    });
}

void ViscousTransfer::prolong(const BlockGrid& coarseGrid, const BlockArray<double, 3>& coarse, const BlockGrid& fineGrid, const ViscousSystem& fine,
                              BlockArray<double, 3>& velocity) const
{
    forEachBlock(fineGrid.count(), [&](int b) {
        const Vec3i first = 4 * fineGrid.coords(b).unaryExpr([](int v) { return v & 1; });
        const auto interpolate = [&](int a, int i, int j, int k) {
            const Interpolation x(i, a == 0), y(j, a == 1), z(k, a == 2);
            double sum = 0.0;
            for (int n = 0; n < 8; ++n) {
                const double weight = x.weight[n & 1] * y.weight[n >> 1 & 1] * z.weight[n >> 2];
                const CellRef from =
                    cellNear(coarseGrid, parent_[b], first.x() + x.at[n & 1], first.y() + y.at[n >> 1 & 1], first.z() + z.at[n >> 2]);
                sum += weight * coarse.block(from.block, a)[from.cell];
            }
            return sum;
        };
        for (int a = 0; a < kAxes; ++a)
            forEachRow(fine.rowsOf(b, a), [&](int r) {
                for (int i = 0; i < kBlockEdge; ++i)
                    if (const int c = r * kBlockEdge + i; fine.unknown.test(b, c, a))
                        velocity.block(b, a)[c] += interpolate(a, i, r % kBlockEdge, r / kBlockEdge);
            });
    });
}

}  // namespace sim
