#pragma once

#include "sim/fabric/fabric.h"

#include <vector>

namespace sim {

/// The connected components of the fabric: parts that nothing ties to each other. They are made of pieces, what strands and faces tie for good,
/// and of ties by contact, which come and go.
class FabricComponents {
 public:
    FabricComponents() = default;
    explicit FabricComponents(const Fabric& fabric);

    int pieces() const { return pieces_; }
    int pieceOf(int vertex) const { return piece_[vertex]; }

    /// Forgets all ties of contact: every piece is a component.
    void untie();
    void tie(int vertex, int other) { tiePieces(piece_[vertex], piece_[other]); }
    void tiePieces(int first, int second);
    /// The lowest piece of a piece's component: it does not depend on the order of the ties.
    int rootOf(int piece) const;
    /// Numbers the components, after the last tie.
    void number();
    int count() const { return count_; }
    int ofPiece(int piece) const { return component_[piece]; }
    int of(int vertex) const { return component_[piece_[vertex]]; }

 private:
    std::vector<int> piece_;           ///< piece of each vertex
    mutable std::vector<int> parent_;  ///< piece next to each, nearer to the lowest of its component
    std::vector<int> component_;
    int pieces_ = 0, count_ = 0;
};

}  // namespace sim
