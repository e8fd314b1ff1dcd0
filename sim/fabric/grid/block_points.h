#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/grid/block_grid.h"
#include "sim/particles/particle_order.h"
#include "sim/transfer/tile.h"

#include <algorithm>
#include <array>
#include <vector>

namespace sim {

/// Points that take part in the matrix-free interpolation, sorted by block and in it by cell: vertices, which carry
/// velocities, or elements, which carry velocity gradients. Weights are computed anew wherever they are needed:
/// products with the system's matrix are bound by memory.
struct BlockPoints {
    struct Cell {
        int corner;  ///< lowest node of a tile that the cell's points reach
        int begin;   ///< first point
    };
    std::vector<int> blockBegin;                     ///< cells of block order.occupied[n] are [blockBegin[n], blockBegin[n + 1])
    std::vector<Cell> cells;                         ///< cells with points, and one behind the last, where the points end
    std::vector<int> id;                             ///< number of each point's vertex or element
    std::array<AlignedArray<double>, kAxes> inCell;  ///< position of each point in its cell [0..1 cells]
    std::vector<int> row;                            ///< row of each point among the sorted particles, after find()

    void clear();
    std::size_t size() const { return id.size(); }
    /// Points of block order.occupied[n] are [begin(n), end(n)).
    int begin(std::size_t n) const { return cells[blockBegin[n]].begin; }
    int end(std::size_t n) const { return cells[blockBegin[n + 1]].begin; }
    /// Makes these the places of the sorted particles whose ids are in [idBegin, idEnd); they are numbered from idBegin on.
    void find(const Particles& particles, const ParticleOrder& order, const BlockGrid& grid, std::uint32_t idBegin, std::uint32_t idEnd);
    /// Makes this the points of `all` whose id `isKept`.
    void select(const BlockPoints& all, auto&& isKept);
};

/// Some numbers of each point, one array per component, which may be read up to kLanes behind the last.
template <int kComponents>
struct PointArray {
    std::array<AlignedArray<double>, kComponents> of;

    void resize(std::size_t points)
    {
        for (AlignedArray<double>& component : of) component.resize(points + 2 * kLanes);
    }
};

/// Values on the faces around one block.
struct FaceTile {
    alignas(64) double v[kAxes][kTileSize];
};

/// W: u at the points of block order.occupied[n].
void gatherValues(const FaceTile& tile, const BlockPoints& points, std::size_t n, PointArray<3>& u);
/// G: ∇u there times the cell size, by the APIC identity: component 3 a + b is 4 Σ w (node − point)_b u_a.
void gatherGradients(const FaceTile& tile, const BlockPoints& points, std::size_t n, PointArray<9>& gradient);

/// Wᵀ: f given to the faces around.
void scatterValues(const BlockPoints& points, std::size_t n, const PointArray<3>& f, FaceTile& tile);

/// G d for kDirections directions d of each point, over the cell size: component 3 k + a is ∂u_a along d_k.
template <int kDirections>
void gatherAlong(const FaceTile& tile, const BlockPoints& points, std::size_t n, const PointArray<3 * kDirections>& d,
                 PointArray<3 * kDirections>& rates);
/// Transpose of gatherAlong.
template <int kDirections>
void scatterAlong(const BlockPoints& points, std::size_t n, const PointArray<3 * kDirections>& d, const PointArray<3 * kDirections>& f,
                  FaceTile& tile);

void BlockPoints::select(const BlockPoints& all, auto&& isKept)
{
    clear();
    for (AlignedArray<double>& x : inCell) x.resize(all.size() + kLanes);
    for (std::size_t n = 0; n + 1 < all.blockBegin.size(); ++n) {
        for (int c = all.blockBegin[n]; c < all.blockBegin[n + 1]; ++c) {
            const int begin = static_cast<int>(size());
            for (int s = all.cells[c].begin; s < all.cells[c + 1].begin; ++s) {
                if (!isKept(all.id[s])) continue;
                for (int a = 0; a < kAxes; ++a) inCell[a][size()] = all.inCell[a][s];
                id.push_back(all.id[s]);
            }
            if (static_cast<int>(size()) > begin) cells.push_back({all.cells[c].corner, begin});
        }
        blockBegin.push_back(static_cast<int>(cells.size()));
    }
    cells.push_back({0, static_cast<int>(size())});
}

/// Makes what the stencils of the box's points reach 0.
inline void clearTile(const OccupiedBox& box, FaceTile& tile)
{
    for (auto& field : tile.v)
        for (int z = box.low[2] - 1; z <= box.high[2] + 2; ++z)
            for (int y = box.low[1] - 1; y <= box.high[1] + 2; ++y) std::fill_n(field + tileIndex(-1, y, z), kTileEdge, 0.0);
}

/// For every occupied block with its number in order.occupied, in parallel: body(n, tile of u).
void forEachBlock(const ParticleOrder& order, const BlockGrid& grid, const BlockArray<double, 3>& u, auto&& body)
{
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int block = order.occupied[n];
        FaceTile tile;
        forEachTileRow(grid, block, OccupiedBox(order.cells(block)), [&](int piece, int cell, int node, auto length) {
            for (int a = 0; a < kAxes; ++a) std::copy_n(u.block(piece, a) + cell, static_cast<int>(length), tile.v[a] + node);
        });
        body(n, tile);
    });
}

/// The packs of faces that have mass, in the arrays of the faces.
struct FaceRows {
    std::vector<int> first;     ///< first face of each pack with mass
    std::vector<char> hasMass;  ///< whether each pack of faces has mass

    void find(const BlockArray<double, 3>& mass);
};

/// For every occupied block: fill(n, empty tile), then adds the tile to u on rows with mass, which are cleared first;
/// blocks of one colour share no face.
void sumOverBlocks(const ParticleOrder& order, const BlockGrid& grid, const FaceRows& rows, BlockArray<double, 3>& u, auto&& fill)
{
    parallelFor(rows.first.size(), 1024, [&](std::size_t r) { std::fill_n(u.block(0) + rows.first[r], kLanes, 0.0); });
    for (const std::vector<int>& color : order.byColor)
        parallelFor(color.size(), [&](std::size_t c) {
            const int block = color[c];
            const OccupiedBox box(order.cells(block));
            FaceTile tile;
            clearTile(box, tile);
            fill(static_cast<std::size_t>(std::ranges::lower_bound(order.occupied, block) - order.occupied.begin()), tile);
            forEachTileRow(grid, block, box, [&](int piece, int cell, int node, auto length) {
                for (int a = 0; a < kAxes; ++a) {
                    double* to = u.block(piece, a) + cell;
                    if (!rows.hasMass[(to - u.block(0)) / kLanes]) continue;
                    for (int i = 0; i < length; ++i) to[i] += tile.v[a][node + i];
                }
            });
        });
}

}  // namespace sim
