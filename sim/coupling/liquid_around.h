#pragma once

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/coupling/cell_stencil.h"
#include "sim/coupling/sorted_vertices.h"
#include "sim/grid/obstacle_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace sim {

/// The liquid in the cells that vertices reach: particles bring it to cells, vertices see it there, both by quadratic B-splines.
class LiquidAround {
 public:
    /// What a pack tells of the liquid of a cell: mass [g], momentum [g cm/s], mass times place [g cm].
    enum Lane { kMass, kMomentum, kMoment = kMomentum + kAxes };

    explicit LiquidAround(std::size_t vertices) : mass_(vertices), distance_(vertices) {}
    LiquidAround(const LiquidAround&) = delete;  // what it has found is referred to

    /// What find has found, which holds until the next find.
    class Found;
    /// Collects sorted liquid in the cells that sorted vertices reach, and samples it at these. Nothing where no particle is in reach.
    std::optional<Found> find(const SortedParticles& liquid, const ObstacleField& obstacles, const SortedVertices& vertices);

    /// Cells of a block, a bit each, by cellRank.
    using CellMask = std::array<std::uint64_t, kBlockCells / 64>;
    /// Some particles of one block: those of [begin, end) that lie in these cells, whose stencils may reach cells that vertices reach.
    struct Part {
        int block, begin, end;
        CellMask cells;
    };
    /// body(particle), ascending.
    template <class Body>
    static void forEachParticle(const ParticleOrder& order, const Part& part, Body&& body);

 private:
    const Pack& cell(int block, int c) const { return reinterpret_cast<const Pack*>(cells_.data())[block * kBlockCells + c]; }
    Pack& cell(int block, int c) { return reinterpret_cast<Pack*>(cells_.data())[block * kBlockCells + c]; }
    void findReached(const SortedVertices& vertices);
    CellMask cellsNear(const std::array<int, 27>& blocks) const;
    bool findNear(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices);
    void addTile(const Pack* tile, const std::array<int, 27>& blocks);
    void collect(const SortedParticles& sorted);
    void sampleAtVertices(const BlockGrid& grid, const ObstacleField& obstacles, const SortedVertices& vertices);
    Vec3 centroidOfRoom(const ObstacleField& obstacles, const SortedVertices& vertices, int block, const CellStencil& stencil, const Vec3& x) const;

    // Of the vertices' blocks.
    AlignedArray<double> cells_;        ///< a pack (Lane) for each cell, and for those of an empty block behind the last
    BlockArray<std::uint8_t> reached_;  ///< whether a vertex reaches each cell
    std::vector<std::uint8_t> blockReached_;
    std::vector<int> solidBlock_;                  ///< block of the liquid's grid where there are solids near, or BlockGrid::kNone
    std::vector<double> mass_, distance_;          ///< Found::massAt and distanceAt of each vertex, known of sorted ones [g, cells]
    std::vector<std::array<int, 27>> nearBlocks_;  ///< blocks of vertices around each block of the liquid
    std::vector<Part> near_;                       ///< parts of the liquid near vertices, in the order of the blocks
    std::vector<int> nearBegin_;                   ///< first part of each block of the liquid; it has none if the next block's is the same
    AlignedArray<double> tiles_;                   ///< what each part's particles bring to the cells of a tile
};

class LiquidAround::Found {
 public:
    /// Mean over the cells around vertex v of the mass in them [g].
    double massAt(std::size_t v) const { return around_->mass_[v]; }
    /// How far the mean place of the liquid that vertex v sees is from that of all room: 0 amid liquid, 0.56 on its flat surface, 0.63 and
    /// 0.73 at 0.1 and 0.25 from that, r beside a drop at r, as of a normal distribution of variance 1/2 [cells].
    double distanceAt(std::size_t v) const { return around_->distance_[v]; }
    std::span<const double> distances() const { return around_->distance_; }  ///< distanceAt of each vertex, known of sorted ones [cells]

    const Pack& cell(int block, int c) const { return around_->cell(block, c); }
    const std::vector<Part>& near() const { return around_->near_; }
    /// The vertices' blocks around a block of the liquid that has particles near; empty ones are the vertices' number of blocks.
    const std::array<int, 27>& blocksAround(int block) const { return around_->nearBlocks_[block]; }

    const ParticleOrder& order() const { return *order_; }  ///< order of the liquid
    const BlockGrid& grid() const { return *grid_; }        ///< grid of the liquid
    const SortedVertices& vertices() const { return *vertices_; }

 private:
    friend LiquidAround;
    Found(const LiquidAround& around, const SortedParticles& liquid, const SortedVertices& vertices)
        : around_(&around), order_(&liquid.order), grid_(&liquid.grid), vertices_(&vertices)
    {
    }

    const LiquidAround* around_;
    const ParticleOrder* order_;
    const BlockGrid* grid_;
    const SortedVertices* vertices_;
};

template <class Body>
void LiquidAround::forEachParticle(const ParticleOrder& order, const Part& part, Body&& body)
{
    const int* start = order.cells(part.block);
    for (std::size_t word = 0; word < part.cells.size(); ++word)
        for (std::uint64_t bits = part.cells[word]; bits != 0; bits &= bits - 1) {
            const int* cell = start + 64 * word + std::countr_zero(bits);
            const int end = std::min(cell[1], part.end);
            for (int s = std::max(cell[0], part.begin); s < end; ++s) body(s);
        }
}

/// 1 of liquid that is at most `touching` away, 0 of what is `apart`, even between.
/// @param distance  LiquidAround::Found::distanceAt, as the others [cells]
inline double wettedPart(double distance, double touching, double apart) { return std::clamp((apart - distance) / (apart - touching), 0.0, 1.0); }

/// body(block) for all blocks of an order that hold something, those of a colour in parallel: they reach no common cell.
template <class Body>
void forEachColored(const ParticleOrder& order, Body&& body)
{
    for (const std::vector<int>& blocks : order.byColor) parallelFor(blocks.size(), [&](std::size_t n) { body(blocks[n]); });
}

}  // namespace sim
