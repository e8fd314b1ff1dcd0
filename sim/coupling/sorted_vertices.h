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

    bool empty() const { return particles.count == 0; }
    std::size_t count() const { return particles.count; }

 private:
    friend class VertexSorter;
    SortedVertices() = default;
};

/// Sorts vertices; it alone has sorted ones.
class VertexSorter {
 public:
    VertexSorter() = default;
    VertexSorter(const VertexSorter&) = delete;  // what it has sorted is referred to

    /// Takes the vertices whose stencils reach blocks of the liquid; what is farther has nothing to do with it. They hold until the next sort.
    SortedVertices& sort(const BlockGrid& liquid, const FabricState& state);

 private:
    SortedVertices sorted_;
    std::vector<std::uint8_t> isNear_;  ///< whether each vertex is taken
};

/// Does a vertex reach the box around the liquid's blocks? Elsewhere the two have nothing to do with each other.
bool reachesLiquid(const BlockGrid& liquid, const FabricState& state);

}  // namespace sim
