#include "sim/solvers/multigrid_level.h"

#include "sim/core/parallel.h"

namespace sim::multigrid {

namespace {

using Level = MultigridLevel;

template <Order order>
[[gnu::always_inline]] inline void sweepRow(const BlockCouplings<float>& couplings, const float* inverse, BlockTile<float>& tile, int r)
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

void loadBlock(const Level& level, int b, const Smoothing& smoothing, BlockTile<float>& tile)
{
    const std::uint64_t rows = level.rows[b];
    const float* x = level.x.block(b);
    if (smoothing.fromZero)
        tile.fill(0, [](int) { return Row<float>{}; });
    else if (smoothing.coarse == nullptr)
        tile.fill(rows, [&](int r) { return loadRow(x + r * kBlockEdge); });
    else {
        const float* correction = smoothing.coarse->x.block(level.parent[b]);
        const float* inverse = level.matrix.block(b, Level::kInverse);
        const int corner = cornerInParent(level.grid.coords(b));
        tile.fill(rows, [&](int r) {
            return Row<float>(loadRow(x + r * kBlockEdge) +
                              whereUnknown(inverse, r, coarseRow(correction, corner, r)));
        });
    }
    const float* rhs = level.r.block(b);
    for (int c = 0; c < kBlockCells; c += kBlockEdge) storeRow(tile.sum + c, loadRow(rhs + c));
}

double dotWithRhs(const Level& level, int b, const BlockTile<float>& tile)
{
    const float* rhs = level.r.block(b);
    Row<double> sum = {};
    forEachRow(level.rows[b], [&](int r) {
        sum += toDouble(loadRow(tile.row(r))) * toDouble(loadRow(rhs + r * kBlockEdge));
    });
    return sumOfRow<double>(sum);
}

}  // namespace

void smooth(MultigridLevel& level, const Smoothing& smoothing)
{
    const std::vector<int>& list = level.colour[smoothing.colour];
    forEachBlockInTile<float>(static_cast<int>(list.size()), [&](int n, BlockTile<float>& tile) {
        const int b = list[n];
        if (level.rows[b] == 0) return;
        loadBlock(level, b, smoothing, tile);
        if (smoothing.alone)
            tile.clearNeighbours();
        else
            addNeighbours(level, b, tile);
        if (smoothing.order == Order::Forward)
            sweepBlock<Order::Forward>(level, b, smoothing.sweeps, tile);
        else
            sweepBlock<Order::Backward>(level, b, smoothing.sweeps, tile);
        float* x = level.x.block(b);
        forEachRow(level.rows[b], [&](int r) { storeRow(x + r * kBlockEdge, loadRow(tile.row(r))); });
        if (smoothing.dots) level.dot[b] = dotWithRhs(level, b, tile);
    });
}

void restrictResidual(const MultigridLevel& fine, MultigridLevel& coarse)
{
    forEachBlockInTile<float>(fine.blocks(), [&](int b, BlockTile<float>& tile) {
        const std::uint64_t rows = fine.rows[b];
        alignas(64) float residual[kBlockCells] = {};
        if (rows != 0) {
            const float *x = fine.x.block(b), *rhs = fine.r.block(b);
            const float* diagonal = fine.matrix.block(b, Level::kDiagonal);
            tile.fill(rows, [&](int r) { return loadRow(x + r * kBlockEdge); });
            for (int c = 0; c < kBlockCells; c += kBlockEdge) storeRow(tile.sum + c, loadRow(rhs + c));
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
