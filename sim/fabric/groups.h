#pragma once

#include "sim/fabric/components.h"
#include "sim/fabric/fabric.h"

#include <span>
#include <vector>

namespace sim {

/// Pieces of fabric that act on each other form a group. What nothing outside of it holds keeps its momentum, but for weight and liquid.
class FabricGroups {
 public:
    explicit FabricGroups(const Fabric& fabric);

    /// Every piece is a group of its own, held where it has pins.
    void begin();
    /// Two pieces, or those of these vertices, act on each other.
    void join(int first, int second);
    void joinVertices(std::span<const int> vertices);
    /// Something outside the fabric acts on the vertex.
    void hold(int vertex) { isHeld_[components_.rootOf(pieceOf(vertex))] = 1; }

    int pieces() const { return components_.pieces(); }
    int pieceOf(int vertex) const { return components_.pieceOf(vertex); }
    /// The piece that stands for the group of a piece, or −1 where it is held.
    int freeGroupOf(int piece) const
    {
        const int root = components_.rootOf(piece);
        return isHeld_[root] != 0 ? -1 : root;
    }
    bool anyFree() const;
    /// Velocity of each piece's group as a whole, where nothing holds it; else 0 [cm/s].
    /// @param mass      of each vertex [g]
    /// @param velocity  of each vertex [cm/s]
    std::vector<Vec3> drifts(std::span<const double> mass, std::span<const Vec3> velocity) const;

 private:
    FabricComponents components_;
    std::vector<char> isPinned_;  ///< whether each piece is pinned
    std::vector<char> isHeld_;    ///< whether each group is held, at its root
};

}  // namespace sim
