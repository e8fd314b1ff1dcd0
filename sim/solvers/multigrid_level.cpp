#include "sim/solvers/multigrid_level.h"

#include "sim/core/parallel.h"

namespace sim::multigrid {

namespace {

using Level = MultigridLevel;

/// A block of x with a plane of zeros below and above, and what stays the same while the block is worked on: the
/// right-hand side plus couplings times neighbours in other blocks. Couplings inside the block are 0 where a cell at
/// its face would meet the wrong cell in memory.
struct Tile {
    alignas(64) float memory[kBlockCells + 2 * kBlockRows] = {};
    alignas(64) float sum[kBlockCells] = {};
    float* x = memory + kBlockRows;

    /// x = row(r) on the given rows, 0 on the others.
    template <class RowOfX>
    void fill(std::uint64_t rows, const RowOfX& row)
    {
        forEachRow(rows, [&](int r) { storeRow<float>(x + r * kBlockEdge, row(r)); });
        forEachRow(~rows, [&](int r) { storeRow<float>(x + r * kBlockEdge, Row<float>{}); });
    }
};

/// Couplings inside a block, times the neighbours in the tile.
struct Couplings {
    Couplings(const Level& level, int b)
        : x(level.matrix.block(b, Level::kCouplingX)), y(level.matrix.block(b, Level::kCouplingY)), z(level.matrix.block(b, Level::kCouplingZ))
    {
    }

    [[gnu::always_inline]] Row<float> acrossRows(const Tile& tile, int c) const
    {
        const float* v = tile.x + c;
        const Row<float> alongY = loadRow(y + c) * loadRow(v - kBlockEdge) + loadRow(y + c + kBlockEdge) * loadRow(v + kBlockEdge);
        const Row<float> alongZ = loadRow(z + c) * loadRow(v - kBlockRows) + loadRow(z + c + kBlockRows) * loadRow(v + kBlockRows);
        return loadRow(tile.sum + c) + alongY + alongZ;
    }
    [[gnu::always_inline]] Row<float> alongRow(Row<float> v, int c) const
    {
        return loadRow(x + c) * __builtin_shufflevector(v, v, 7, 0, 1, 2, 3, 4, 5, 6) +
               loadUnalignedRow(x + c + 1) * __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 0);
    }

    const float *x, *y, *z;
};

template <Order order>
[[gnu::always_inline]] inline void sweepRow(const Couplings& couplings, const float* inverse, Tile& tile, int r)
{
    typedef int Mask __attribute__((vector_size(32)));
    constexpr Mask kEvenCells = {-1, 0, -1, 0, -1, 0, -1, 0};
    constexpr Mask kFirst = order == Order::Forward ? kEvenCells : ~kEvenCells;

    const int c = r * kBlockEdge;
    const Row<float> across = couplings.acrossRows(tile, c), inv = loadRow(inverse + c);
    Row<float> v = loadRow(tile.x + c);
    v = kFirst ? inv * (across + couplings.alongRow(v, c)) : v;
    v = kFirst ? v : inv * (across + couplings.alongRow(v, c));
    storeRow(tile.x + c, v);
}

template <Order order>
void sweepBlock(const Level& level, int b, int sweeps, Tile& tile)
{
    const Couplings couplings(level, b);
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
int cornerInParent(const Vec3i& coords) { return cellInBlock((coords.x() & 1) * 4, (coords.y() & 1) * 4, (coords.z() & 1) * 4); }

Row<float> whereUnknown(const float* inverse, int r, Row<float> v) { return loadRow(inverse + r * kBlockEdge) != 0.0f ? v : Row<float>{}; }

/// tile.sum = right-hand side.
void sumRhs(const Level& level, int b, Tile& tile)
{
    const float* rhs = level.r.block(b);
    forEachRow(level.rows[b], [&](int r) { storeRow(tile.sum + r * kBlockEdge, loadRow(rhs + r * kBlockEdge)); });
}

/// tile.sum = right-hand side plus couplings times x of the neighbour blocks.
void sumRhsAndNeighbours(const Level& level, int b, Tile& tile)
{
    const auto& near = level.neighbours[b];
    const float *rhs = level.r.block(b), *left = level.x.block(near[0]), *right = level.x.block(near[1]);
    const float *leftFace = level.face(0, b), *rightFace = level.face(0, near[1]);
    typedef int Mask __attribute__((vector_size(32)));
    constexpr Mask kFirstCell = {-1, 0, 0, 0, 0, 0, 0, 0}, kLastCell = {0, 0, 0, 0, 0, 0, 0, -1};
    forEachRow(level.rows[b], [&](int r) {
        const int c = r * kBlockEdge;
        const Row<float> none = {}, l = leftFace[r] * left[c + kBlockEdge - 1] - none, h = rightFace[r] * right[c] - none;
        storeRow<float>(tile.sum + c, loadRow(rhs + c) + (kFirstCell ? l : none) + (kLastCell ? h : none));
    });
    const auto add = [&](int r, const float* coupling, int block, int from) {
        const Row<float> x = loadRow(level.x.block(block) + from * kBlockEdge);
        storeRow<float>(tile.sum + r * kBlockEdge, loadRow(tile.sum + r * kBlockEdge) + loadRow(coupling) * x);
    };
    for (int n = 0; n < kBlockEdge; ++n) {
        const int f = n * kBlockEdge, lastY = f + kBlockEdge - 1, lastZ = n + kBlockRows - kBlockEdge;
        add(f, level.face(1, b) + f, near[2], lastY);
        add(lastY, level.face(1, near[3]) + f, near[3], f);
        add(n, level.face(2, b) + f, near[4], lastZ);
        add(lastZ, level.face(2, near[5]) + f, near[5], n);
    }
}

void loadBlock(const Level& level, int b, const Smoothing& smoothing, Tile& tile)
{
    const std::uint64_t rows = level.rows[b];
    const float* x = level.x.block(b);
    if (smoothing.fromZero) tile.fill(0, [](int) { return Row<float>{}; });
    else if (smoothing.coarse == nullptr) tile.fill(rows, [&](int r) { return loadRow(x + r * kBlockEdge); });
    else {
        const float* correction = smoothing.coarse->x.block(level.parent[b]);
        const float* inverse = level.matrix.block(b, Level::kInverse);
        const int corner = cornerInParent(level.grid.coords(b));
        tile.fill(rows, [&](int r) { return Row<float>(loadRow(x + r * kBlockEdge) + whereUnknown(inverse, r, coarseRow(correction, corner, r))); });
    }
}

double dotWithRhs(const Level& level, int b, const Tile& tile)
{
    const float* rhs = level.r.block(b);
    Row<double> sum = {};
    forEachRow(level.rows[b], [&](int r) { sum += toDouble(loadRow(tile.x + r * kBlockEdge)) * toDouble(loadRow(rhs + r * kBlockEdge)); });
    return sumOfRow<double>(sum);
}

}  // namespace

void smooth(MultigridLevel& level, const Smoothing& smoothing)
{
    const std::vector<int>& list = level.colour[smoothing.colour];
    forEachBlockInTile<Tile>(static_cast<int>(list.size()), [&](int n, Tile& tile) {
        const int b = list[n];
        if (level.rows[b] == 0) {
            if (smoothing.dots) level.dot[b] = 0.0;
            return;
        }
        loadBlock(level, b, smoothing, tile);
        if (smoothing.alone) sumRhs(level, b, tile);
        else sumRhsAndNeighbours(level, b, tile);
        if (smoothing.order == Order::Forward) sweepBlock<Order::Forward>(level, b, smoothing.sweeps, tile);
        else sweepBlock<Order::Backward>(level, b, smoothing.sweeps, tile);
        float* x = level.x.block(b);
        forEachRow(level.rows[b], [&](int r) { storeRow(x + r * kBlockEdge, loadRow(tile.x + r * kBlockEdge)); });
        if (smoothing.dots) level.dot[b] = dotWithRhs(level, b, tile);
    });
}

void restrictResidual(const MultigridLevel& fine, MultigridLevel& coarse)
{
    forEachBlockInTile<Tile>(fine.blocks(), [&](int b, Tile& tile) {
        const std::uint64_t rows = fine.rows[b];
        alignas(64) float residual[kBlockCells] = {};
        if (rows != 0) {
            const float *x = fine.x.block(b), *diagonal = fine.matrix.block(b, Level::kDiagonal);
            tile.fill(rows, [&](int r) { return loadRow(x + r * kBlockEdge); });
            sumRhsAndNeighbours(fine, b, tile);
            const Couplings couplings(fine, b);
            forEachRow(rows, [&](int r) {
                const int c = r * kBlockEdge;
                const Row<float> v = loadRow(tile.x + c), d = loadRow(diagonal + c);
                const Row<float> sum = couplings.acrossRows(tile, c) + couplings.alongRow(v, c) - d * v;
                storeRow<float>(residual + c, d != 0.0f ? sum : Row<float>{});
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
            storeRow<float>(x + r * kBlockEdge, loadRow(x + r * kBlockEdge) + whereUnknown(inverse, r, coarseRow(correction, corner, r)));
        });
    });
}

}  // namespace sim::multigrid
