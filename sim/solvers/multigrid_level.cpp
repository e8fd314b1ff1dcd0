#include "sim/solvers/multigrid_level.h"

#include "sim/core/parallel.h"

namespace sim::multigrid {

namespace {

using Level = MultigridLevel;

template <Order order>
void sweepRow(const BlockCouplings<float>& couplings, const float* inverse, BlockTile<float>& tile, int r)
{
    typedef int Mask __attribute__((vector_size(32)));
    constexpr Mask kEvenCells = {-1, 0, -1, 0, -1, 0, -1, 0};
    constexpr Mask kFirst = order == Order::Forward ? kEvenCells : ~kEvenCells;

    const Row<float> across = couplings.acrossRows(tile, r), inv = loadRow(inverse + r * kBlockEdge);
    Row<float> v = loadRow(tile.row(r));
    v = kFirst ? inv * (across + couplings.alongRow(tile, r, v)) : v;
    v = kFirst ? v : inv * (across + couplings.alongRow(tile, r, v));
    storeRow(tile.row(r), v);
}

template <Order order>
void sweepBlock(const Level& level, int b, int sweeps, BlockTile<float>& tile)
{
    const BlockCouplings<float> couplings = level.couplings(b);
    const float* inverse = level.matrix.block(b, Level::kInverse);
    const std::uint64_t rows = level.rows[b];
    constexpr std::uint64_t kFirst = order == Order::Forward ? kEvenRows : ~kEvenRows;
    for (int s = 0; s < sweeps; ++s) {
        forEachRow(rows & kFirst, [&](int r) { sweepRow<order>(couplings, inverse, tile, r); });
        forEachRow(rows & ~kFirst, [&](int r) { sweepRow<order>(couplings, inverse, tile, r); });
    }
}

/// Row r of the correction for a block whose corner in the coarse block is cell `corner`.
Row<float> coarseRow(const float* coarse, int corner, int r)
{
    float v[4];
    __builtin_memcpy(v, coarse + corner + cellInBlock(0, r % 8 / 2, r / 16), sizeof(v));
    return Row<float>{v[0], v[0], v[1], v[1], v[2], v[2], v[3], v[3]};
}

/// The cell of the coarse block where a block's part of it begins.
int cornerInParent(const Vec3i& coords)
{
    return cellInBlock((coords.x() & 1) * 4, (coords.y() & 1) * 4, (coords.z() & 1) * 4);
}

Row<float> whereUnknown(const float* inverse, int r, Row<float> v)
{
    return loadRow(inverse + r * kBlockEdge) != 0.0f ? v : Row<float>{};
}

void addNeighbours(const Level& level, int b, BlockTile<float>& tile)
{
    sim::addNeighbours(
        tile, b, level.neighbours[b], [&](int n) { return level.couplings(n); },
        [&](int n, int r) { return loadRow(level.x.block(n) + r * kBlockEdge); },
        [&](int n, int c) { return level.x.block(n)[c]; });
}

}  // namespace

void smooth(MultigridLevel& level, int colour, int sweeps, Order order, bool fromZero, bool neighbours,
            const MultigridLevel* coarse)
{
    const std::vector<int>& list = level.colour[colour];
    forEachBlock(static_cast<int>(list.size()), [&](int n) {
        const int b = list[n];
        const std::uint64_t rows = level.rows[b];
        if (rows == 0) return;
        BlockTile<float> tile;
        tile.clear();
        float* x = level.x.block(b);
        if (!fromZero) {
            forEachRow(rows, [&](int r) { storeRow(tile.row(r), loadRow(x + r * kBlockEdge)); });
            if (coarse != nullptr) {
                const float* correction = coarse->x.block(level.parent[b]);
                const float* inverse = level.matrix.block(b, Level::kInverse);
                const int corner = cornerInParent(level.grid.coords(b));
                forEachRow(rows, [&](int r) {
                    storeRow<float>(tile.row(r), loadRow(tile.row(r)) +
                                                     whereUnknown(inverse, r, coarseRow(correction, corner, r)));
                });
            }
        }
        std::copy_n(level.r.block(b), kBlockCells, tile.sum);
        if (neighbours)
            addNeighbours(level, b, tile);
        else
            tile.clearNeighbours();
        if (order == Order::Forward)
            sweepBlock<Order::Forward>(level, b, sweeps, tile);
        else
            sweepBlock<Order::Backward>(level, b, sweeps, tile);
        forEachRow(rows, [&](int r) { storeRow(x + r * kBlockEdge, loadRow(tile.row(r))); });
    });
}

void dotProducts(MultigridLevel& level)
{
    forEachBlock(level.blocks(), [&](int b) {
        const float *x = level.x.block(b), *r = level.r.block(b);
        Row<double> sum = {};
        forEachRow(level.rows[b], [&](int row) {
            sum += toDouble(loadRow(x + row * kBlockEdge)) * toDouble(loadRow(r + row * kBlockEdge));
        });
        level.dot[b] = sumOfRow<double>(sum);
    });
}

void restrictResidual(const MultigridLevel& fine, MultigridLevel& coarse)
{
    forEachBlock(fine.blocks(), [&](int b) {
        const std::uint64_t rows = fine.rows[b];
        alignas(64) float residual[kBlockCells] = {};
        if (rows != 0) {
            BlockTile<float> tile;
            tile.clear();
            const float* x = fine.x.block(b);
            const float* diagonal = fine.matrix.block(b, Level::kDiagonal);
            forEachRow(rows, [&](int r) { storeRow(tile.row(r), loadRow(x + r * kBlockEdge)); });
            std::copy_n(fine.r.block(b), kBlockCells, tile.sum);
            addNeighbours(fine, b, tile);
            const BlockCouplings<float> couplings = fine.couplings(b);
            forEachRow(rows, [&](int r) {
                const Row<float> v = loadRow(tile.row(r)), d = loadRow(diagonal + r * kBlockEdge);
                const Row<float> sum = couplings.acrossRows(tile, r) + couplings.alongRow(tile, r, v) - d * v;
                storeRow<float>(residual + r * kBlockEdge, d != 0.0f ? sum : Row<float>{});
            });
        }
        float* out = coarse.r.block(fine.parent[b]) + cornerInParent(fine.grid.coords(b));
        for (int k = 0; k < 4; ++k)
            for (int j = 0; j < 4; ++j) {
                const float* p = residual + cellInBlock(0, 2 * j, 2 * k);
                const Row<float> sum = (loadRow(p) + loadRow(p + 8)) + (loadRow(p + 64) + loadRow(p + 72));
                for (int i = 0; i < 4; ++i) out[cellInBlock(i, j, k)] = sum[2 * i] + sum[2 * i + 1];
            }
    });
}

void prolong(const MultigridLevel& coarse, MultigridLevel& fine, int colour)
{
    const std::vector<int>& list = fine.colour[colour];
    forEachBlock(static_cast<int>(list.size()), [&](int n) {
        const int b = list[n], corner = cornerInParent(fine.grid.coords(b));
        float* x = fine.x.block(b);
        const float* correction = coarse.x.block(fine.parent[b]);
        const float* inverse = fine.matrix.block(b, Level::kInverse);
        forEachRow(fine.rows[b], [&](int r) {
            storeRow<float>(x + r * kBlockEdge, loadRow(x + r * kBlockEdge) +
                                                    whereUnknown(inverse, r, coarseRow(correction, corner, r)));
        });
    });
}

}  // namespace sim::multigrid
