#include "sim/core/parallel.h"
#include "sim/solvers/multigrid_level.h"

namespace sim::multigrid {

namespace {

using Level = MultigridLevel;

/// Couplings of row r to the lower neighbours along an axis, those across the face of the block included.
[[gnu::always_inline]] inline Row<float> lowerRow(const Level& level, int axis, int b, int r)
{
    const int j = r % kBlockEdge, k = r / kBlockEdge;
    if (axis == 1 && j == 0) return loadRow(level.face(1, b) + k * kBlockEdge);
    if (axis == 2 && k == 0) return loadRow(level.face(2, b) + j * kBlockEdge);
    Row<float> row = loadRow(level.matrix.block(b, Level::kCouplingX + axis) + r * kBlockEdge);
    if (axis == 0) row[0] = level.face(0, b)[r];
    return row;
}

[[gnu::always_inline]] inline void storeLowerRow(Level& level, int axis, int b, int r, Row<float> row)
{
    const int j = r % kBlockEdge, k = r / kBlockEdge;
    if (axis == 0) {
        level.face(0, b)[r] = row[0];
        row[0] = 0.0f;
    }
    if (axis == 1 && j == 0) {
        storeRow(level.face(1, b) + k * kBlockEdge, row);
        row = Row<float>{};
    }
    if (axis == 2 && k == 0) {
        storeRow(level.face(2, b) + j * kBlockEdge, row);
        row = Row<float>{};
    }
    storeRow(level.matrix.block(b, Level::kCouplingX + axis) + r * kBlockEdge, row);
}

/// Sum of the six couplings of each cell of row r; lower(axis, block, r) gives rows of couplings.
/// @param near   numbers of the blocks at +x, +y, +z
template <class T, class LowerRow>
Row<T> sumOfCouplings(const LowerRow& lower, int b, const std::array<int, kAxes>& near, int r)
{
    constexpr int kLast = kBlockEdge - 1;
    const int j = r % kBlockEdge, k = r / kBlockEdge;
    const Row<T> x = lower(0, b, r), y = lower(1, b, r), z = lower(2, b, r);
    const Row<T> upX = upperAlongX<T>(x, lower(0, near[0], r)[0]);
    const Row<T> upY = j < kLast ? lower(1, b, r + 1) : lower(1, near[1], r - kLast);
    const Row<T> upZ = k < kLast ? lower(2, b, r + kBlockEdge) : lower(2, near[2], j);
    return (x + upX) + (y + upY) + (z + upZ);
}

/// Diagonal and its inverse of one row; returns its unknowns.
[[gnu::always_inline]] inline CellSet finishRow(Level& level, int b, int r, Row<float> diagonal)
{
    const int c = r * kBlockEdge;
    const auto isUnknown = diagonal > 0.0f;
    const Row<float> one = {1, 1, 1, 1, 1, 1, 1, 1};
    storeRow<float>(level.matrix.block(b, Level::kDiagonal) + c, isUnknown ? diagonal : Row<float>{});
    storeRow<float>(level.matrix.block(b, Level::kInverse) + c, isUnknown ? one / (isUnknown ? diagonal : one) : Row<float>{});
    return cellsOfRow(isUnknown, r);
}

/// Remember which rows hold unknowns; the others get 0 in the vectors.
void finishBlock(Level& level, int b, CellSet unknown)
{
    level.rows[b] = rowsOf(unknown);
    forEachRow(~level.rows[b], [&](int r) {
        storeRow(level.x.block(b) + r * kBlockEdge, Row<float>{});
        storeRow(level.r.block(b) + r * kBlockEdge, Row<float>{});
    });
}

/// Four numbers, the sums of neighbouring pairs.
Row<float> pairSums(Row<float> a)
{
    const Row<float> b = a + __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6);
    return __builtin_shufflevector(b, b, 0, 2, 4, 6, 0, 2, 4, 6);
}

/// Couplings (kinds 0, 1, 2) and Dirichlet parts (kind 3) of one coarse row: from the row's children at the left (c = 0)
/// and right (c = 1), each half of it.
Row<float> gatherRow(const Level& fine, int kind, const std::array<int, 2>& child, int fineRow)
{
    const auto half = [&](int b) {
        if (b == BlockGrid::kNone) return Row<float>{};
        const auto row = [&](int r) { return kind < kAxes ? lowerRow(fine, kind, b, r) : loadRow(fine.dirichlet.block(b) + r * kBlockEdge); };
        Row<float> sum = row(fineRow);
        if (kind != 1) sum += row(fineRow + 1);
        if (kind != 2) sum += row(fineRow + kBlockEdge);
        if (kind != 1 && kind != 2) sum += row(fineRow + kBlockEdge + 1);
        return kind == 0 ? Row<float>(__builtin_shufflevector(sum, sum, 0, 2, 4, 6, 0, 2, 4, 6)) : pairSums(sum);
    };
    return 0.5f * __builtin_shufflevector(half(child[0]), half(child[1]), 0, 1, 2, 3, 8, 9, 10, 11);
}

}  // namespace

void takeFinest(const BlockGrid& grid, const PoissonMatrix& matrix, MultigridLevel& level)
{
    forEachBlock(level.blocks(), [&](int b) {
        const auto lower = [&](int axis, int block, int r) { return loadRow(matrix.coupling(axis, block) + r * kBlockEdge); };
        const auto& around = grid.neighbours(b);
        const std::array<int, kAxes> near = {around[kBlockAbove[0]], around[kBlockAbove[1]], around[kBlockAbove[2]]};
        CellSet unknown = {};
        for (int r = 0; r < kBlockRows; ++r) {
            const int c = r * kBlockEdge;
            const Row<double> d = loadRow(matrix.diagonal(b) + c), open = d - sumOfCouplings<double>(lower, b, near, r);
            storeRow(level.dirichlet.block(b) + c, toFloat(open > kDirichletRounding * d ? open : Row<double>{}));
            for (int axis = 0; axis < kAxes; ++axis) storeLowerRow(level, axis, b, r, toFloat(lower(axis, b, r)));
            unknown |= finishRow(level, b, r, toFloat(d));
        }
        finishBlock(level, b, unknown);
    });
}

void gatherCoarse(const MultigridLevel& fine, MultigridLevel& coarse)
{
    forEachBlock(coarse.blocks(), [&](int b) {
        for (int r = 0; r < kBlockRows; ++r) {
            const int j = r % kBlockEdge, k = r / kBlockEdge, pair = (k / 4 * 2 + j / 4) * 2;
            const std::array<int, 2> child = {coarse.children[b][pair], coarse.children[b][pair + 1]};
            const int fineRow = k % 4 * 2 * kBlockEdge + j % 4 * 2;
            for (int axis = 0; axis < kAxes; ++axis) storeLowerRow(coarse, axis, b, r, gatherRow(fine, axis, child, fineRow));
            storeRow(coarse.dirichlet.block(b) + r * kBlockEdge, gatherRow(fine, kAxes, child, fineRow));
            storeRow(coarse.r.block(b) + r * kBlockEdge, Row<float>{});
        }
    });
    const auto lower = [&](int axis, int block, int r) { return lowerRow(coarse, axis, block, r); };
    forEachBlock(coarse.blocks(), [&](int b) {
        const auto& around = coarse.neighbours[b];
        const std::array<int, kAxes> near = {around[1], around[3], around[5]};
        CellSet unknown = {};
        for (int r = 0; r < kBlockRows; ++r) {
            const Row<float> dirichlet = loadRow(coarse.dirichlet.block(b) + r * kBlockEdge);
            unknown |= finishRow(coarse, b, r, dirichlet + sumOfCouplings<float>(lower, b, near, r));
        }
        finishBlock(coarse, b, unknown);
    });
}

}  // namespace sim::multigrid
