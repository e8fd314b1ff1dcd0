#pragma once

#include "sim/core/parallel.h"
#include "sim/grid/face_fields.h"
#include "sim/transfer/tile.h"

namespace sim {

/// What the particles of one block give to the faces around them.
struct ScatterTile {
    alignas(64) double v[6][kTileSize];  ///< kinds of FaceFields::sums
};

inline void clearTile(const OccupiedBox& box, ScatterTile& tile)
{
    for (auto& field : tile.v)
        for (int z = box.low[2] - 1; z <= box.high[2] + 2; ++z)
            for (int y = box.low[1] - 1; y <= box.high[1] + 2; ++y) std::fill_n(field + tileIndex(-1, y, z), kTileEdge, 0.0);
}

inline void addTileToGrid(const BlockGrid& grid, int block, const OccupiedBox& box, const ScatterTile& tile, FaceFields& faces)
{
    forEachTileRow(grid, block, box, [&](int piece, int cell, int node, auto length) {
        for (int kind = 0; kind < 6; ++kind) {
            double* to = faces.sums.block(piece, kind) + cell;
            const double* from = tile.v[kind] + node;
            for (int n = 0; n < length; ++n) to[n] += from[n];
        }
    });
}

/// Mass and momentum of every face: fill(block, box, worker, tile) adds those of one block's particles to a cleared
/// tile. Tiles are added to the grid in 8 colours: blocks of one colour share no face, so the order of additions is
/// fixed.
template <class Fill>
void scatterBlocks(const ParticleOrder& order, const BlockGrid& grid, FaceFields& faces, Fill&& fill)
{
    faces.sums.resize(grid.count());
    parallelFor(grid.count(), 4, [&](std::size_t b) { std::fill_n(faces.sums.block(static_cast<int>(b)), faces.sums.kStride, 0.0); });
    for (const std::vector<int>& color : order.byColor)
        parallelForWorkers(color.size(), 1, [&](std::size_t n, int worker) {
            const int block = color[n];
            const OccupiedBox box(order.cells(block));
            ScatterTile tile;
            clearTile(box, tile);
            fill(block, box, worker, tile);
            addTileToGrid(grid, block, box, tile, faces);
        });
}

}  // namespace sim
