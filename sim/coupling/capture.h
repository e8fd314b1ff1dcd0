#pragma once

#include "sim/core/simd.h"
#include "sim/coupling/porous_law.h"
#include "sim/coupling/sorted_vertices.h"
#include "sim/settings.h"

#include <numeric>
#include <span>
#include <vector>

namespace sim {

/// Fabric takes up liquid from the particles around until its pores are full (model-fluid 9.1). Both meet in the cells that they reach;
/// each particle gives some of its mass, at its own velocity. Mass and momentum are kept to round-off.
class Capture {
 public:
    /// @param nominalMass  of a particle [g]
    Capture(const Fabric& fabric, const Settings& settings, double nominalMass);

    /// Over dt [s], with the liquid sorted. Velocities of pinned vertices stay.
    /// @return mass taken up [g]
    double capture(double dt, const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices, LiquidParticles& liquid,
                   FabricState& state);
    /// What pinned vertices, whose velocities stay, got of the liquid's momentum in the last call [g cm/s].
    Vec3 toPins() const { return std::accumulate(toPins_.begin(), toPins_.end(), Vec3::Zero().eval()); }
    /// The same of each vertex.
    std::span<const Vec3> toPinsByVertex() const { return toPins_; }
    /// Removes the particles that have given all they had; their numbers change.
    void dropEmptied(LiquidParticles& liquid);

 private:
    /// What a pack tells of a cell: its liquid, and what vertices want of that, later the share that they took.
    enum Lane { kMass, kMomentum, kDemand = kMomentum + kAxes };

    double roomOf(std::size_t v, const FabricState& state) const { return capacity_[v] - state.absorbed[v]; }
    bool findThirsty(const SortedVertices& vertices, const FabricState& state);
    void collect(const BlockGrid& grid, const ParticleOrder& order, const LiquidParticles& liquid);
    void ask(double dt, const SortedVertices& vertices, const FabricState& state);
    void settle(const SortedVertices& vertices);
    double wet(const SortedVertices& vertices, FabricState& state);
    void drain(const BlockGrid& grid, LiquidParticles& liquid);
    double takeRemnants(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices, LiquidParticles& liquid,
                        FabricState& state);
    Pack& cellOf(int block, int cell) { return reinterpret_cast<Pack*>(cells_.data())[block * kBlockCells + cell]; }
    void give(std::size_t v, double mass, const Vec3& momentum, FabricState& state);
    bool findNear(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices);
    void addTile(const Pack* tile, const std::array<int, 27>& blocks);
    template <class Body>
    void forEachThirsty(const SortedVertices& vertices, int block, Body&& body) const;
    template <class Body>
    void forEachNear(const BlockGrid& grid, const LiquidParticles& liquid, std::size_t part, Body&& body) const;

    const Fabric& fabric_;
    std::vector<double> capacity_;              ///< of each vertex [g]
    std::vector<double> ratePerVertex_;         ///< share of the liquid around that it takes per time [1/s]
    double leastMass_;                          ///< of a particle that stays [g]

    // Of the vertices' blocks.
    AlignedArray<double> cells_;                ///< a pack (Lane) for each cell, and for those of an empty block behind the last
    BlockArray<std::uint8_t> reached_;          ///< by a vertex that has room
    std::vector<std::uint8_t> blockReached_;
    // Of the step.
    std::vector<double> wanted_, around_;       ///< of each vertex [g]
    std::vector<Vec3> toPins_;                  ///< of each vertex [g cm/s]
    std::vector<std::uint8_t> thirsty_;         ///< of each block of the vertices: has vertices with room
    std::vector<std::array<int, 27>> nearBlocks_;  ///< of each block of the liquid: vertices' blocks around; empty where none is reached
    /// Particles of one block whose stencils may reach cells that thirsty vertices reach.
    struct Part {
        int block, begin, end;
    };
    std::vector<Part> near_;                    ///< in the order of the blocks
    std::vector<int> nearBegin_;                ///< of each block of the liquid: its first part; it has none if the next block's is the same
    AlignedArray<double> tiles_;                ///< of each part: what its particles bring to the cells of a tile
    std::vector<std::size_t> emptied_;          ///< particles, ascending
};

}  // namespace sim
