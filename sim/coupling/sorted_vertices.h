#pragma once

#include "sim/fabric/fabric.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// The vertices that may share faces with the liquid, sorted by cell, in blocks of their own: those that they reach. The cells are the
/// liquid's.
struct SortedVertices {
    Particles particles;  ///< positions; id is the vertex
    BlockGrid grid;
    ParticleOrder order;

    /// Takes the vertices whose stencils reach blocks of the liquid; what is farther has nothing to do with it.
    void sort(const BlockGrid& liquid, const FabricState& state);
    bool empty() const { return particles.count == 0; }
    std::size_t count() const { return particles.count; }

 private:
    std::vector<std::uint8_t> isNear_;  ///< of each vertex
};

/// Does a vertex reach the box around the liquid's blocks? Elsewhere the two have nothing to do with each other.
bool reachesLiquid(const BlockGrid& liquid, const FabricState& state);

}  // namespace sim
