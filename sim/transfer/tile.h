#pragma once

#include "sim/grid/block_grid.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// Nodes −1 … 9 of a block along each axis, which is all that the stencils of its particles touch, as one local array.
/// Node (x, y, z) stands at tileIndex(x, y, z).
inline constexpr int kTileEdge = 12;  ///< 11 used
inline constexpr int kTileSize = kTileEdge * kTileEdge * kTileEdge;
inline constexpr int kTileStrideY = kTileEdge, kTileStrideZ = kTileEdge * kTileEdge;
constexpr int tileIndex(int x, int y, int z) { return (x + 1) + (y + 1) * kTileStrideY + (z + 1) * kTileStrideZ; }

/// The cells of a block that hold particles, as a box of cells [low, high].
struct OccupiedBox {
    /// @param cellStart  the block's 513 entries of ParticleOrder::cellStart
    explicit OccupiedBox(const int* cellStart)
    {
        for (int i = 0; i < kBlockEdge; ++i)
            for (int j = 0; j < kBlockEdge; ++j) {
                const int* column = cellStart + cellRank(i, j, 0);
                if (column[0] == column[kBlockEdge]) continue;
                include(0, i);
                include(1, j);
                for (int k = 0; k < kBlockEdge; ++k)
                    if (column[k] != column[k + 1]) include(2, k);
            }
    }
    void include(int axis, int i)
    {
        low[axis] = std::min(low[axis], i);
        high[axis] = std::max(high[axis], i);
    }
    int low[3] = {kBlockEdge, kBlockEdge, kBlockEdge}, high[3] = {-1, -1, -1};
};

/// For each piece of a tile's rows that one block holds, call piece(block, first index in the block, first index in the tile,
/// length), restricted to the nodes low − 1 … high + 2 that the particles of the box touch.
template <class Piece>
inline void forEachTileRow(const BlockGrid& grid, int block, const OccupiedBox& box, Piece&& piece)
{
    const auto& neighbours = grid.neighbours(block);
    const bool left = box.low[0] == 0, right = box.high[0] + 2 >= kBlockEdge;
    for (int z = box.low[2] - 1; z <= box.high[2] + 2; ++z)
        for (int y = box.low[1] - 1; y <= box.high[1] + 2; ++y) {
            const int* row = neighbours.data() + neighbourIndex(-1, y >> 3, z >> 3);
            const int cell = cellInBlock(0, y & 7, z & 7), node = tileIndex(0, y, z);
            if (left) piece(row[0], cell + kBlockEdge - 1, node - 1, std::integral_constant<int, 1>{});
            piece(row[1], cell, node, std::integral_constant<int, kBlockEdge>{});
            if (right) piece(row[2], cell, node + kBlockEdge, std::integral_constant<int, 2>{});
        }
}

}  // namespace sim
