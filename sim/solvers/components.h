#pragma once

#include "sim/solvers/poisson_matrix.h"

#include <cstdint>
#include <vector>

namespace sim {

/// The connected components of a PoissonMatrix, and which of them are closed: no row of them has a Dirichlet part, so that the matrix
/// leaves a constant undetermined on each.
class ConnectedComponents {
 public:
    void find(const BlockGrid& grid, const PoissonMatrix& matrix);

    int closedCount() const { return closed_; }
    int count() const { return all_; }

    /// Number of the closed component that a cell belongs to, or −1.
    int closedOf(int block, int cell) const { return lookUp(component_, block, cell); }
    /// Number of its component among all, or −1.
    int of(int block, int cell) const { return lookUp(number_, block, cell); }
    /// The one component among all that cells of a block belong to; kSeveral if not all belong to the same, −1 if none belongs to any.
    int ofBlock(int block) const;
    static constexpr int kSeveral = -2;

    /// Subtract from v, on each closed component, its mean over it.
    template <class T>
    void removeMeans(BlockArray<T>& v);

 private:
    static constexpr std::uint16_t kNoLabel = 0xffff;

    int lookUp(const std::vector<int>& numbers, int block, int cell) const
    {
        const std::uint16_t label = label_.block(block)[cell];
        return label == kNoLabel ? -1 : numbers[first_[block] + label];
    }
    int labelBlock(int block, const BlockGrid& grid, const PoissonMatrix& matrix);
    void joinBlocks(const BlockGrid& grid, const PoissonMatrix& matrix);
    void numberComponents();
    int root(int piece);
    void join(int a, int b);

    // A piece is what hangs together inside one block; pieces of block b are first_[b] … first_[b + 1] − 1.
    BlockArray<std::uint16_t> label_;       ///< piece of each cell, counted within its block
    BlockArray<std::uint8_t> isOpenLocal_;  ///< whether each piece is open, at its label
    std::vector<int> first_, parent_;
    std::vector<std::uint8_t> isOpen_;  ///< whether the component of each root piece is open
    std::vector<int> component_;        ///< number of each piece's closed component, or −1
    std::vector<int> number_;           ///< number of each piece's component among all
    std::vector<int> blocks_;           ///< blocks that hold closed pieces
    std::vector<double> pieceSum_, pieceCells_, sum_, cells_;
    int closed_ = 0, all_ = 0;
};

}  // namespace sim
