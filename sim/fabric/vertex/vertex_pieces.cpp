#include "sim/fabric/vertex/vertex_system.h"

#include <Eigen/Dense>

// Pieces of cloth as wholes. What is left of a linear solve is small against gravity, but the incomplete factor of stiff cloth hardly knows
// how easily all of it moves together, and as steps begin with the forces of the last such an error stays: a sheet slid 11 % too slowly.

namespace sim {

void VertexSystem::findFreePieces()
{
    std::vector<char> isHeld(components_.pieces(), 0);
    for (std::size_t v = 0; v < fabric_.vertexCount(); ++v)
        if (fabric_.pinned[v] || unknowns_.isOnStrand(static_cast<int>(v))) isHeld[components_.pieceOf(static_cast<int>(v))] = 1;
    std::vector<int> number(components_.pieces(), -1);
    freePieceOf_.assign(fabric_.vertexCount(), -1);
    int count = 0;
    for (int v : shells_.vertices()) {
        const int piece = components_.pieceOf(v);
        if (isHeld[piece]) continue;
        if (number[piece] < 0) number[piece] = count++;
        freePieceOf_[v] = number[piece];
    }
    pieceStiffness_.resize(count);
    pieceForce_.resize(count);
}

/// Σ of the matrix over the vertices of each piece: the cloth's own forces do not answer to moving all of it.
void VertexSystem::weighFreePieces(const NewtonPoint& at, std::span<const ObstacleContact> obstacles, const ActiveContacts* contacts)
{
    if (pieceStiffness_.empty()) return;
    const double perStep2 = 1.0 / (at.h * at.h);
    for (Mat3& m : pieceStiffness_) m.setZero();
    for (std::size_t v = 0; v < freePieceOf_.size(); ++v)
        if (freePieceOf_[v] >= 0) pieceStiffness_[freePieceOf_[v]].diagonal() += perStep2 * at.inertia[v];
    for (const ObstacleContact& contact : obstacles)
        if (freePieceOf_[contact.vertex] >= 0) pieceStiffness_[freePieceOf_[contact.vertex]] += contact.stiffness;
    for (std::size_t i = 0; contacts && i < contacts->size(); ++i) {
        const int first = freePieceOf_[contacts->vertices[i][0]], second = freePieceOf_[contacts->vertices[i][3]];
        if (first == second) continue;
        const Vec3& n = contacts->normal[i];
        const double across = contacts->frictionStiffness[i];
        const Mat3 block = (contacts->stiffness[i] - across) * n * n.transpose() + across * Mat3::Identity();
        for (int piece : {first, second})
            if (piece >= 0) pieceStiffness_[piece] += block;
    }
}

/// Moves each piece to where the forces on it as a whole are in balance. Pieces that touch take each other to stay where they are: as their
/// pairs answer to the difference of their moves alone, the error never grows.
void VertexSystem::balanceFreePieces()
{
    if (pieceForce_.empty()) return;
    for (Vec3& force : pieceForce_) force.setZero();
    const auto slots = [&](int v) { return std::array{unknowns_.slot[v], unknowns_.slot[v] + kLanes, unknowns_.slot[v] + 2 * kLanes}; };
    for (int v : shells_.vertices())
        if (freePieceOf_[v] >= 0)
            for (int a = 0; a < 3; ++a) pieceForce_[freePieceOf_[v]][a] += residual_[slots(v)[a]];
    for (std::size_t piece = 0; piece < pieceForce_.size(); ++piece)
        pieceForce_[piece] = pieceStiffness_[piece].ldlt().solve(pieceForce_[piece]).eval();
    for (int v : shells_.vertices())
        if (freePieceOf_[v] >= 0)
            for (int a = 0; a < 3; ++a) solution_[slots(v)[a]] += pieceForce_[freePieceOf_[v]][a];
}

}  // namespace sim
