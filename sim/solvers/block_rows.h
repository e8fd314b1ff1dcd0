#pragma once

#include "sim/core/parallel.h"
#include "sim/grid/block_grid.h"

#include <bit>
#include <cstdint>

// A block is 64 rows of 8 cells along x; row r = 8 k + j. The solver's loops go row by row, one vector each.

namespace sim {

inline constexpr int kBlockRows = kBlockEdge * kBlockEdge;

namespace detail {
template <class T>
struct RowOf {
    typedef T Type __attribute__((vector_size(kBlockEdge * sizeof(T))));
};
}  // namespace detail

/// Eight cells side by side.
template <class T>
using Row = typename detail::RowOf<T>::Type;

template <class T>
inline Row<T> loadRow(const T* p)
{
    Row<T> row;
    __builtin_memcpy(&row, __builtin_assume_aligned(p, sizeof(row)), sizeof(row));
    return row;
}

template <class T>
inline void storeRow(T* p, Row<T> row)
{
    __builtin_memcpy(__builtin_assume_aligned(p, sizeof(row)), &row, sizeof(row));
}

/// The cells one lower along x; the first is given.
template <class T>
inline Row<T> lowerAlongX(Row<T> row, T first)
{
    const Row<T> f = first - Row<T>{};
    return __builtin_shufflevector(row, f, 8, 0, 1, 2, 3, 4, 5, 6);
}

/// The cells one higher along x; the last is given.
template <class T>
inline Row<T> upperAlongX(Row<T> row, T last)
{
    const Row<T> l = last - Row<T>{};
    return __builtin_shufflevector(row, l, 1, 2, 3, 4, 5, 6, 7, 8);
}

template <class T>
inline T sumOfRow(Row<T> a)
{
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

template <class T>
inline T maxOfRow(Row<T> a)
{
    T m = a[0];
    for (int i = 1; i < kBlockEdge; ++i) m = a[i] > m || a[i] != a[i] ? a[i] : m;
    return m;
}

/// One bit for each cell where the mask is set.
template <class Mask>
inline std::uint64_t bitsOf(Mask mask)
{
    std::uint64_t bits = 0;
    for (int i = 0; i < kBlockEdge; ++i) bits |= std::uint64_t{mask[i] != 0} << i;
    return bits;
}

inline Row<float> toFloat(Row<double> row)
{
    return __builtin_convertvector(row, Row<float>);
}

inline Row<double> toDouble(Row<float> row)
{
    return __builtin_convertvector(row, Row<double>);
}

/// parallelFor over blocks: body(b), each writes its own. Few blocks are quicker done by one thread than shared.
template <class Body>
inline void forEachBlock(int blocks, Body&& body)
{
    constexpr std::size_t kBlocksPerTask = 4;
    parallelFor(static_cast<std::size_t>(blocks), kBlocksPerTask, [&](std::size_t b) { body(static_cast<int>(b)); });
}

/// Rows with j + k even, as a set of bits.
inline constexpr std::uint64_t kEvenRows = 0xAA55AA55AA55AA55u;

/// body(r) for each row of the set.
template <class Body>
inline void forEachRow(std::uint64_t rows, Body&& body)
{
    for (; rows != 0; rows &= rows - 1) body(std::countr_zero(rows));
}

/// A block of the unknown framed by rows of zeros, and what its neighbours add: with it every cell of the block
/// is treated alike.
template <class T>
struct BlockTile {
    static constexpr int kRowsPerPlane = kBlockEdge + 2;
    static constexpr int kFrameRows = kRowsPerPlane * kRowsPerPlane;
    static constexpr int kUpY = kBlockEdge, kUpZ = kRowsPerPlane * kBlockEdge;  ///< steps to the next rows in x

    alignas(64) T x[kFrameRows * kBlockEdge];
    alignas(64) T sum[kBlockCells];  ///< right-hand side plus couplings times neighbours along y and z
    alignas(64) T left[kBlockRows];  ///< x beyond the left end of each row …
    alignas(64) T right[kBlockRows]; ///< … and beyond the right end

    BlockTile() { std::fill(x, x + kFrameRows * kBlockEdge, T(0)); }

    T* row(int r) { return x + ((r / kBlockEdge + 1) * kRowsPerPlane + r % kBlockEdge + 1) * kBlockEdge; }
    const T* row(int r) const { return const_cast<BlockTile*>(this)->row(r); }

    /// x = row(r) on the given rows, 0 on the others.
    template <class RowOfX>
    void fill(std::uint64_t rows, const RowOfX& rowOfX)
    {
        forEachRow(rows, [&](int r) { storeRow<T>(row(r), rowOfX(r)); });
        forEachRow(~rows, [&](int r) { storeRow<T>(row(r), Row<T>{}); });
    }
    void clearSum() { std::fill(sum, sum + kBlockCells, T(0)); }
    void clearNeighbours()
    {
        std::fill(left, left + kBlockRows, T(0));
        std::fill(right, right + kBlockRows, T(0));
    }
};

/// forEachBlock with a tile to work in: body(b, tile).
template <class T, class Body>
inline void forEachBlockInTile(int blocks, Body&& body)
{
    constexpr int kBlocksPerTask = 4;
    parallelFor(static_cast<std::size_t>((blocks + kBlocksPerTask - 1) / kBlocksPerTask), [&](std::size_t task) {
        const int first = static_cast<int>(task) * kBlocksPerTask;
        BlockTile<T> tile;
        for (int b = first; b < std::min(blocks, first + kBlocksPerTask); ++b) body(b, tile);
    });
}

/// Couplings of one block to the lower neighbours along each axis, and along x beyond the right end of each row.
template <class T>
struct BlockCouplings {
    const T *x, *y, *z, *right;

    /// Couplings times neighbours, without those along x. The last rows of a plane and the last plane take their upper
    /// coupling from wherever the next row in memory is: it meets the zeros of the frame.
    [[gnu::always_inline]] Row<T> acrossRows(const BlockTile<T>& tile, int r) const
    {
        using Tile = BlockTile<T>;
        const T* p = tile.row(r);
        const int c = r * kBlockEdge;
        const Row<T> alongY = loadRow(y + c) * loadRow(p - Tile::kUpY) + loadRow(y + c + kBlockEdge) * loadRow(p + Tile::kUpY);
        const Row<T> alongZ = loadRow(z + c) * loadRow(p - Tile::kUpZ) + loadRow(z + c + kBlockRows) * loadRow(p + Tile::kUpZ);
        return loadRow(tile.sum + c) + alongY + alongZ;
    }
    /// Couplings times neighbours along x.
    [[gnu::always_inline]] Row<T> alongRow(const BlockTile<T>& tile, int r, Row<T> v) const
    {
        const Row<T> lower = loadRow(x + r * kBlockEdge);
        return lower * lowerAlongX<T>(v, tile.left[r]) +
               upperAlongX<T>(lower, right[r]) * upperAlongX<T>(v, tile.right[r]);
    }
};

/// Fill what the tile holds of the neighbours; its sum must hold the right-hand side already.
/// @param neighbours   numbers of the blocks at −x +x −y +y −z +z
/// @param couplings    couplings(block) of any block, the empty one included
/// @param row          row(block, r): that row of the unknown; cell(block, c): one value of it
template <class T, class Couplings, class RowOfX, class CellOfX>
inline void addNeighbours(BlockTile<T>& tile, int block, const std::array<int, 6>& neighbours, const Couplings& couplings,
                          const RowOfX& row, const CellOfX& cell)
{
    const BlockCouplings<T> own = couplings(block);
    const BlockCouplings<T> beyondY = couplings(neighbours[3]), beyondZ = couplings(neighbours[5]);
    for (int r = 0; r < kBlockRows; ++r) {
        tile.left[r] = cell(neighbours[0], r * kBlockEdge + kBlockEdge - 1);
        tile.right[r] = cell(neighbours[1], r * kBlockEdge);
    }
    const auto add = [&](int r, const T* coupling, Row<T> x) {
        storeRow<T>(tile.sum + r * kBlockEdge, loadRow(tile.sum + r * kBlockEdge) + loadRow(coupling) * x);
    };
    for (int n = 0; n < kBlockEdge; ++n) {
        const int firstY = n * kBlockEdge, lastY = firstY + kBlockEdge - 1;
        const int firstZ = n, lastZ = n + kBlockRows - kBlockEdge;
        add(firstY, own.y + firstY * kBlockEdge, row(neighbours[2], lastY));
        add(lastY, beyondY.y + firstY * kBlockEdge, row(neighbours[3], firstY));
        add(firstZ, own.z + firstZ * kBlockEdge, row(neighbours[4], lastZ));
        add(lastZ, beyondZ.z + firstZ * kBlockEdge, row(neighbours[5], firstZ));
    }
}

}  // namespace sim
