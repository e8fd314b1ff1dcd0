#pragma once

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/particle_order.h"
#include "sim/transfer/tile.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace sim {

/// Where a point is in its block. Small: products with the system's matrix are bound by memory, weights are cheap to
/// compute anew.
struct PointPlace {
    Vec3 inCell;              ///< position in its cell, in cells, 0..1
    std::array<int, 3> cell;  ///< the cell in its block, 0..7
};

/// Quadratic B-spline weights of one point on the three face grids, as products of one-dimensional ones. Along each
/// axis a face grid is either that axis' own (index 1: faces at the cell's sides) or stands at the cells' middles
/// (index 0).
struct PointWeights {
    explicit PointWeights(const PointPlace& place);

    /// All of them squared: those of the diagonal of Wᵀ K W.
    PointWeights squared() const;
    /// Index in a tile of the first of the 27 faces normal to `axis`.
    int first(int axis) const { return tileIndex(node[axis == 0][0], node[axis == 1][1], node[axis == 2][2]); }

    HalfPack x[2], zx[2];  ///< along x: weights, and weights times (node − point); the fourth lane is 0
    HalfPack y[2], z[2];   ///< along y and z: weights
    double offset[2][3];   ///< point − middle node along each axis [cells]
    int node[2][3];        ///< first node along each axis, in the block
};

/// Which part of the matrix-free interpolation a point takes part in, sorted by block: vertices carry velocities,
/// elements velocity gradients.
struct BlockPoints {
    /// Points of block order.occupied[n] are [begin[n], begin[n + 1]).
    std::vector<int> begin;
    std::vector<int> id;  ///< number of the vertex or element
    std::vector<PointPlace> place;

    void clear();
    std::span<const int> idsOf(std::size_t n) const { return std::span(id).subspan(begin[n], begin[n + 1] - begin[n]); }
    const PointPlace* placesOf(std::size_t n) const { return place.data() + begin[n]; }
};

/// Values on the faces around one block.
struct FaceTile {
    alignas(64) double v[kAxes][kTileSize];
};

/// W: u at a point.
Vec3 interpolate(const FaceTile& tile, const PointWeights& w);
/// Wᵀ: f given to the faces around.
void distribute(const PointWeights& w, const Vec3& f, FaceTile& tile);
/// G = ∇u at a point times the cell size, by the APIC identity: row a is 4 Σ w (node − point) u_a.
Mat3 gradientAt(const FaceTile& tile, const PointWeights& w);
/// Transpose of gradientAt.
void distributeGradient(const PointWeights& w, const Mat3& t, FaceTile& tile);

/// Diagonal of what distributeGradient ∘ (T = H G) ∘ gradientAt does to faces normal to `axis`: zᵀ B z with z = 4 w
/// (node − point).
void distributeSquare(const PointWeights& w, int axis, const Mat3& b, FaceTile& tile);

/// Makes what the stencils of the box's points reach 0, with the node behind it that they load with weight 0.
inline void clearTile(const OccupiedBox& box, FaceTile& tile)
{
    for (auto& field : tile.v)
        for (int z = box.low[2] - 1; z <= box.high[2] + 2; ++z)
            for (int y = box.low[1] - 1; y <= box.high[1] + 2; ++y)
                std::fill_n(field + tileIndex(-1, y, z), kTileEdge, 0.0);
}

/// For every occupied block with its number in order.occupied, in parallel: body(n, tile of u).
void forEachBlock(const ParticleOrder& order, const BlockGrid& grid, const BlockArray<double, 3>& u, auto&& body)
{
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int block = order.occupied[n];
        const OccupiedBox box(order.cells(block));
        FaceTile tile;
        clearTile(box, tile);
        forEachTileRow(grid, block, box, [&](int piece, int cell, int node, auto length) {
            for (int a = 0; a < kAxes; ++a)
                std::copy_n(u.block(piece, a) + cell, static_cast<int>(length), tile.v[a] + node);
        });
        body(n, static_cast<const FaceTile&>(tile));
    });
}

/// For every occupied block: fill(n, empty tile), then adds the tile to u, which is cleared first; blocks of one colour
/// share no face.
void sumOverBlocks(const ParticleOrder& order, const BlockGrid& grid, BlockArray<double, 3>& u, auto&& fill)
{
    parallelFor(grid.count(), 4, [&](std::size_t b) { std::fill_n(u.block(static_cast<int>(b)), u.kStride, 0.0); });
    for (const std::vector<int>& color : order.byColor)
        parallelFor(color.size(), [&](std::size_t c) {
            const int block = color[c];
            const OccupiedBox box(order.cells(block));
            FaceTile tile;
            clearTile(box, tile);
            fill(static_cast<std::size_t>(std::ranges::lower_bound(order.occupied, block) - order.occupied.begin()),
                 tile);
            forEachTileRow(grid, block, box, [&](int piece, int cell, int node, auto length) {
                for (int a = 0; a < kAxes; ++a) {
                    double* to = u.block(piece, a) + cell;
                    for (int i = 0; i < length; ++i) to[i] += tile.v[a][node + i];
                }
            });
        });
}

}  // namespace sim
