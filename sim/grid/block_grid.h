#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/types.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace sim {

inline constexpr int kBlockEdge = 8;                                      ///< cells per block edge
inline constexpr int kBlockCells = kBlockEdge * kBlockEdge * kBlockEdge;  ///< 512

/// Index of cell (i, j, k), each 0..7, in the arrays of a block: x fastest. Nodes and lower faces share it.
constexpr int cellInBlock(int i, int j, int k) { return (k * kBlockEdge + j) * kBlockEdge + i; }

/// Index into BlockGrid::neighbours for the block at (dx, dy, dz), each −1..1.
constexpr int neighbourIndex(int dx, int dy, int dz) { return (dz + 1) * 9 + (dy + 1) * 3 + (dx + 1); }
inline constexpr int kBlockItself = neighbourIndex(0, 0, 0);
/// Indices of the neighbours below and above along each axis.
inline constexpr std::array<int, kAxes> kBlockBelow = {neighbourIndex(-1, 0, 0), neighbourIndex(0, -1, 0), neighbourIndex(0, 0, -1)};
inline constexpr std::array<int, kAxes> kBlockAbove = {neighbourIndex(1, 0, 0), neighbourIndex(0, 1, 0), neighbourIndex(0, 0, 1)};

/// The blocks of 8³ cells that exist: a sparse grid without bounds. Cell (i, j, k) has its lower corner at
/// origin + (i, j, k) dx and belongs to block floor((i, j, k) / 8). Blocks are kept sorted by their
/// coordinates, so that their numbers, and every sum over them, depend on the set of blocks alone.
class BlockGrid {
 public:
    static constexpr int kNone = -1;
    static constexpr int kMaxCoordinate = 1 << 20;  ///< block coordinates lie in [−2^20, 2^20)

    double dx = 1.0;             ///< cell size [cm]
    Vec3 origin = Vec3::Zero();  ///< lower corner of cell (0, 0, 0) [cm]

    int count() const { return static_cast<int>(coords_.size()); }
    const Vec3i& coords(int block) const { return coords_[block]; }
    const std::vector<Vec3i>& coords() const { return coords_; }

    /// Numbers of the 27 blocks around a block, itself in the middle; count() where there is none. Fields keep
    /// an empty block of zeros at number count() for that purpose (see BlockArray).
    const std::array<int, 27>& neighbours(int block) const { return neighbours_[block]; }

    /// The neighbours that share a side with the block: below and above along x, then y, then z.
    std::array<int, 2 * kAxes> neighboursAtSides(int block) const
    {
        std::array<int, 2 * kAxes> sides;
        for (int a = 0; a < kAxes; ++a) {
            sides[2 * a] = neighbours_[block][kBlockBelow[a]];
            sides[2 * a + 1] = neighbours_[block][kBlockAbove[a]];
        }
        return sides;
    }

    /// Number of the block at these coordinates, or kNone.
    int find(const Vec3i& coords) const;

    /// Replace the set of blocks. The coordinates may come in any order; each at most once.
    void setBlocks(std::span<const Vec3i> coords);

    /// Lower corner of a block [cm].
    Vec3 lowerCorner(int block) const { return origin + dx * kBlockEdge * coords_[block].cast<double>(); }

 private:
    std::vector<Vec3i> coords_;
    std::vector<std::array<int, 27>> neighbours_;
    std::vector<std::uint64_t> keys_;  ///< keys of an open-addressing hash table, from coordinates to block numbers; size a power of two
    std::vector<int> values_;          ///< values of that table: block numbers
};

/// kKinds numbers for each cell of each block: block-major, so that one block is one contiguous piece. There is one
/// block more than the grid has: the empty one, all zeros, that stands for every missing neighbour.
template <class T, int kKinds = 1>
class BlockArray {
 public:
    static constexpr std::size_t kStride = static_cast<std::size_t>(kKinds) * kBlockCells;

    /// Values of the blocks are kept by number; the empty block is cleared.
    void resize(int blocks)
    {
        values_.resize((static_cast<std::size_t>(blocks) + 1) * kStride);
        std::fill_n(block(blocks), kStride, T{});
    }
    T* block(int b, int kind = 0) { return values_.data() + b * kStride + kind * kBlockCells; }
    const T* block(int b, int kind = 0) const { return values_.data() + b * kStride + kind * kBlockCells; }
    std::size_t size() const { return values_.size(); }  ///< values, the empty block's included
    void swap(BlockArray& other) noexcept { values_.swap(other.values_); }

 private:
    AlignedArray<T> values_;
};

/// Where something of the block lies that may reach outside: its neighbour's number and the index in it.
struct CellRef {
    int block, cell;
};

/// Cell (i, j, k) relative to a block, each −8..15.
inline CellRef cellNear(const BlockGrid& grid, int block, int i, int j, int k)
{
    const int bi = (i >> 3), bj = (j >> 3), bk = (k >> 3);
    return {grid.neighbours(block)[neighbourIndex(bi, bj, bk)], cellInBlock(i & 7, j & 7, k & 7)};
}

}  // namespace sim
