#pragma once

#include "sim/solvers/block_rows.h"

namespace sim {

/// A block of the unknown framed by rows of zeros, and what its neighbours add: with it every cell of the block
/// is treated alike.
template <class T>
struct FramedTile {
    static constexpr int kRowsPerPlane = kBlockEdge + 2;
    static constexpr int kFrameRows = kRowsPerPlane * kRowsPerPlane;
    static constexpr int kUpY = kBlockEdge, kUpZ = kRowsPerPlane * kBlockEdge;  ///< steps to the next rows in x

    alignas(64) T x[kFrameRows * kBlockEdge];
    alignas(64) T sum[kBlockCells];   ///< right-hand side plus couplings times neighbours along y and z
    alignas(64) T left[kBlockRows];   ///< x beyond the left end of each row
    alignas(64) T right[kBlockRows];  ///< x beyond the right end of each row

    FramedTile() { std::fill(x, x + kFrameRows * kBlockEdge, T(0)); }

    T* row(int r) { return x + ((r / kBlockEdge + 1) * kRowsPerPlane + r % kBlockEdge + 1) * kBlockEdge; }
    const T* row(int r) const { return const_cast<FramedTile*>(this)->row(r); }

    /// x = row(r) on the given rows, 0 on the others.
    template <class RowOfX>
    void fill(std::uint64_t rows, const RowOfX& rowOfX)
    {
        forEachRow(rows, [&](int r) { storeRow<T>(row(r), rowOfX(r)); });
        forEachRow(~rows, [&](int r) { storeRow<T>(row(r), Row<T>{}); });
    }
    void clearSum() { std::fill(sum, sum + kBlockCells, T(0)); }
};

/// Couplings of one block to the lower neighbours along each axis, and along x beyond the right end of each row.
template <class T>
struct BlockCouplings {
    const T *x, *y, *z, *right;

    /// Couplings times neighbours, without those along x. The last rows of a plane and the last plane take their upper
    /// coupling from wherever the next row in memory is: it meets the zeros of the frame.
    [[gnu::always_inline]] Row<T> acrossRows(const FramedTile<T>& tile, int r) const
    {
        using Tile = FramedTile<T>;
        const T* p = tile.row(r);
        const int c = r * kBlockEdge;
        const Row<T> alongY = loadRow(y + c) * loadRow(p - Tile::kUpY) + loadRow(y + c + kBlockEdge) * loadRow(p + Tile::kUpY);
        const Row<T> alongZ = loadRow(z + c) * loadRow(p - Tile::kUpZ) + loadRow(z + c + kBlockRows) * loadRow(p + Tile::kUpZ);
        return loadRow(tile.sum + c) + alongY + alongZ;
    }
    /// Couplings times neighbours along x.
    [[gnu::always_inline]] Row<T> alongRow(const FramedTile<T>& tile, int r, Row<T> v) const
    {
        const Row<T> lower = loadRow(x + r * kBlockEdge);
        return lower * lowerAlongX<T>(v, tile.left[r]) + upperAlongX<T>(lower, right[r]) * upperAlongX<T>(v, tile.right[r]);
    }
};

/// Fill what the tile holds of the neighbours; its sum must hold the right-hand side already.
/// @param neighbours   numbers of the blocks at −x +x −y +y −z +z
/// @param couplings    couplings(block) of any block, the empty one included
/// @param row          row(block, r): that row of the unknown; cell(block, c): one value of it
template <class T, class Couplings, class RowOfX, class CellOfX>
inline void addNeighbours(FramedTile<T>& tile, int block, const std::array<int, 6>& neighbours, const Couplings& couplings, const RowOfX& row,
                          const CellOfX& cell)
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
