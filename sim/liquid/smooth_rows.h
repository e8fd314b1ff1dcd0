#pragma once

#include "sim/core/simd.h"
#include "sim/grid/rows.h"

#include <cstdint>

// Rows of cells with what lies around them, and the passes and differences of smooth fields on them (liquid/README.md, Surface tension).

namespace sim {

/// Weights of a pass along one axis. With these its fourth cumulant is 0, and differences that are smoothed across have
/// an error that is the same in all directions: otherwise drops have edges and corners.
inline constexpr double kSide = 1.0 / 6.0, kMiddle = 4.0 / 6.0;

/// Rows of one kind of a field in a block and around it.
template <int kKinds>
struct RowsAround {
    const BlockArray<double, kKinds>& field;
    int kind;
    const int* neighbours;  ///< neighbours of the block

    /// Row (j, k), j and k in −1..8; with a side that of the block to the left (−1) or right (+1).
    Pack at(int j, int k, int side = 0) const
    {
        return loadPack(field.block(neighbours[neighbourIndex(side, j >> 3, k >> 3)], kind) + cellInBlock(0, j & 7, k & 7));
    }
    /// Row (j, k) one cell to the left or right, from the row itself.
    Pack leftOf(int j, int k, Pack row) const { return shiftRight(at(j, k, -1), row); }
    Pack rightOf(int j, int k, Pack row) const { return shiftLeft(row, at(j, k, 1)); }
};

/// Values of a field below and above the cells of a row of a block; a wall in the way mirrors.
struct Sides {
    Pack below, above;
};
class SidesInBlock {
 public:
    /// @param wall  null where there is none
    SidesInBlock(const BlockGrid& grid, int block, const BlockArray<double>& field, const BlockBits<>* wall)
        : rows_(grid, block), bits_(grid, block), field_(field), wall_(wall)
    {
    }

    Pack own(int j, int k) const { return rows_.row(field_, 0, j, k); }
    Sides along(int axis, int j, int k, Pack own) const
    {
        Sides sides{rows_.below(field_, 0, axis, j, k), rows_.above(field_, 0, axis, j, k)};
        if (!wall_) return sides;
        sides.below = select(rowBits(bits_.below(*wall_, 0, axis, k), j), own, sides.below);
        sides.above = select(rowBits(bits_.above(*wall_, 0, axis, k), j), own, sides.above);
        return sides;
    }

 private:
    RowAccess rows_;
    BitAccess bits_;
    const BlockArray<double>& field_;
    const BlockBits<>* wall_;
};

/// Bits of a block and their neighbours along some axes.
inline void dilate(const BlockGrid& grid, int block, int firstAxis, int endAxis, const BlockBits<>& from, BlockBits<>& to)
{
    const BitAccess bits(grid, block);
    for (int k = 0; k < kBlockEdge; ++k) {
        std::uint64_t any = from.block(block)[k];
        for (int a = firstAxis; a < endAxis; ++a) any |= bits.below(from, 0, a, k) | bits.above(from, 0, a, k);
        to.block(block)[k] = any;
    }
}

/// ∂/∂x, ∂/∂y and ∂/∂z of the cells of a row, smoothed across [1/cell].
struct Slope {
    Pack x, y, z;
};
template <int kKinds>
Slope slopeOfRow(const RowsAround<kKinds>& rows, int j, int k)
{
    Slope slope{};
    for (int dk = -1; dk <= 1; ++dk)
        for (int dj = -1; dj <= 1; ++dj) {
            const Pack row = rows.at(j + dj, k + dk);
            const Pack left = rows.leftOf(j + dj, k + dk, row);
            const Pack right = rows.rightOf(j + dj, k + dk, row);
            const Pack across = kSide * (left + right) + kMiddle * row;
            const double wj = dj == 0 ? kMiddle : kSide, wk = dk == 0 ? kMiddle : kSide;
            slope.x += (0.5 * wj * wk) * (right - left);
            slope.y += (0.5 * dj * wk) * across;
            slope.z += (0.5 * dk * wj) * across;
        }
    return slope;
}

}  // namespace sim
