#pragma once

#include "sim/fabric/fabric.h"
#include "sim/particles/particle_order.h"

namespace sim {

/// The fabric's vertices sorted by cell, in blocks of their own: those that vertices reach. The cells are the liquid's.
struct SortedVertices {
    LiquidParticles particles;  ///< positions; id is the vertex
    BlockGrid grid;
    ParticleOrder order;

    void sort(const BlockGrid& liquid, const FabricState& state);
    std::size_t count() const { return particles.count; }

 private:
    Ledger ledger_;             ///< of what is outside the domain; nothing is
};

/// Does a vertex reach the box around the liquid's blocks? Elsewhere the two have nothing to do with each other.
bool reachesLiquid(const BlockGrid& liquid, const FabricState& state);

}  // namespace sim
