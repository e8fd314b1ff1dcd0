#pragma once

#include "sim/core/simd.h"
#include "sim/grid/face_fields.h"

#include <cstdint>

namespace sim {

/// The bits of row j of a layer of a block, and of row (j, k) of its layers.
[[gnu::always_inline]] inline PackMask rowBits(std::uint64_t layer, int j) { return maskOfBits(layer >> (j * kBlockEdge)); }
[[gnu::always_inline]] inline PackMask rowBits(const std::uint64_t* layers, int j, int k) { return rowBits(layers[k], j); }

/// Access to a block's cells in rows of 8 along x, and to the rows around them, across block borders.
struct RowAccess {
    RowAccess(const BlockGrid& grid, int block) : neighbours(grid.neighbours(block).data()) {}

    /// Row (j, k) of a field, j and k in −1..8 but not both outside.
    template <class T, int kKinds>
    Pack row(const BlockArray<T, kKinds>& field, int kind, int j, int k) const
    {
        return loadPack(field.block(neighbours[neighbourIndex(0, j >> 3, k >> 3)], kind) + cellInBlock(0, j & 7, k & 7));
    }
    /// The values at i − 1 and i + 1 of row (j, k).
    template <class T, int kKinds>
    Pack left(const BlockArray<T, kKinds>& field, int kind, int j, int k) const
    {
        return shiftRight(loadPack(field.block(neighbours[neighbourIndex(-1, 0, 0)], kind) + cellInBlock(0, j, k)), row(field, kind, j, k));
    }
    template <class T, int kKinds>
    Pack right(const BlockArray<T, kKinds>& field, int kind, int j, int k) const
    {
        return shiftLeft(row(field, kind, j, k), loadPack(field.block(neighbours[neighbourIndex(1, 0, 0)], kind) + cellInBlock(0, j, k)));
    }
    /// The values one cell below along an axis, and one above.
    template <class T, int kKinds>
    Pack below(const BlockArray<T, kKinds>& field, int kind, int axis, int j, int k) const
    {
        return axis == 0 ? left(field, kind, j, k) : axis == 1 ? row(field, kind, j - 1, k) : row(field, kind, j, k - 1);
    }
    template <class T, int kKinds>
    Pack above(const BlockArray<T, kKinds>& field, int kind, int axis, int j, int k) const
    {
        return axis == 0 ? right(field, kind, j, k) : axis == 1 ? row(field, kind, j + 1, k) : row(field, kind, j, k + 1);
    }

    const int* neighbours;
};

/// Access to bits beside a block: word k shifted by one cell along an axis, so that each bit tells of the cell below (or above).
struct BitAccess {
    BitAccess(const BlockGrid& grid, int block) : neighbours(grid.neighbours(block).data()) {}

    template <int kKinds>
    std::uint64_t below(const BlockBits<kKinds>& bits, int kind, int axis, int k) const
    {
        constexpr std::uint64_t kFirstColumn = 0x0101010101010101u;
        const std::uint64_t* own = bits.block(neighbours[kBlockItself], kind);
        if (axis == 0) return (own[k] & ~(kFirstColumn << 7)) << 1 | (bits.block(neighbours[kBlockBelow[0]], kind)[k] >> 7 & kFirstColumn);
        if (axis == 1) return own[k] << 8 | bits.block(neighbours[kBlockBelow[1]], kind)[k] >> 56;
        return k > 0 ? own[k - 1] : bits.block(neighbours[kBlockBelow[2]], kind)[kBlockEdge - 1];
    }
    template <int kKinds>
    std::uint64_t above(const BlockBits<kKinds>& bits, int kind, int axis, int k) const
    {
        constexpr std::uint64_t kFirstColumn = 0x0101010101010101u;
        const std::uint64_t* own = bits.block(neighbours[kBlockItself], kind);
        if (axis == 0) return (own[k] & ~kFirstColumn) >> 1 | (bits.block(neighbours[kBlockAbove[0]], kind)[k] & kFirstColumn) << 7;
        if (axis == 1) return own[k] >> 8 | bits.block(neighbours[kBlockAbove[1]], kind)[k] << 56;
        return k < kBlockEdge - 1 ? own[k + 1] : bits.block(neighbours[kBlockAbove[2]], kind)[0];
    }

    const int* neighbours;
};

}  // namespace sim
