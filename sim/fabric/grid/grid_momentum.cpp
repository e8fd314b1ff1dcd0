#include "sim/fabric/grid/grid_solver.h"

// What iterations have left of the balance of forces changes the momentum of fabric that nothing holds.

namespace sim {

/// The group of the fabric in each block and in those beside it; −1 where it is held or there is none. Pieces in blocks beside each other
/// act on each other by faces that both may reach.
void GridFabricSolver::findGroups(std::span<const ObstacleContact> touching)
{
    groups_.begin();
    for (const ObstacleContact& contact : touching)
        for (int v : contact.vertices()) groups_.hold(v);
    const BlockGrid& grid = particles_.grid();
    const BlockPoints& vertices = particles_.vertices();
    const std::vector<int>& occupied = particles_.order().occupied;
    std::vector<int>& piece = groupOfBlock_;
    piece.assign(grid.count(), -1);
    for (std::size_t n = 0; n < occupied.size(); ++n)
        for (int i = vertices.begin(n); i < vertices.end(n); ++i) {
            int& first = piece[occupied[n]];
            const int own = groups_.pieceOf(vertices.id[i]);
            if (first < 0) first = own;
            groups_.join(first, own);
        }
    nearBlock_.assign(grid.count(), -1);
    for (int b = 0; b < grid.count(); ++b)
        for (int neighbour : grid.neighbours(b)) {
            if (neighbour == grid.count() || piece[neighbour] < 0) continue;
            if (nearBlock_[b] < 0) nearBlock_[b] = piece[neighbour];
            groups_.join(nearBlock_[b], piece[neighbour]);
        }
    for (int b = 0; b < grid.count(); ++b) groupOfBlock_[b] = nearBlock_[b] < 0 ? -1 : groups_.freeGroupOf(nearBlock_[b]);
}

void GridFabricSolver::conserveMomentum(std::span<const ObstacleContact> touching)
{
    findGroups(touching);
    if (groups_.anyFree()) system_.balanceMomentum(start_, groupOfBlock_, groups_.pieces(), velocity_);
}

}  // namespace sim
