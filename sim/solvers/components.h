#pragma once

#include "sim/solvers/poisson_matrix.h"

#include <cstdint>
#include <vector>

namespace sim {

/// The connected pieces of a PoissonMatrix that are closed: no row of them has a Dirichlet part, so that the matrix
/// leaves a constant undetermined on each.
class ClosedComponents {
 public:
    void find(const BlockGrid& grid, const PoissonMatrix& matrix);

    int count() const { return closed_; }

    /// Number of the closed component that a cell belongs to, or −1.
    int of(int block, int cell) const
    {
        const std::uint16_t label = label_.block(block)[cell];
        return label == kNoLabel ? -1 : component_[first_[block] + label];
    }

    /// Subtract from v, on each closed component, its mean over it.
    template <class T>
    void removeMeans(BlockArray<T>& v);

 private:
    static constexpr std::uint16_t kNoLabel = 0xffff;

    int labelBlock(int block, const BlockGrid& grid, const PoissonMatrix& matrix);
    void joinBlocks(const BlockGrid& grid, const PoissonMatrix& matrix);
    void countClosed();
    int root(int piece);
    void join(int a, int b);

    // A piece is what hangs together inside one block; pieces of block b are first_[b] … first_[b + 1] − 1.
    BlockArray<std::uint16_t> label_;       ///< piece of each cell, counted within its block
    BlockArray<std::uint8_t> isOpenLocal_;  ///< of each piece, at its label
    std::vector<int> first_, parent_;
    std::vector<std::uint8_t> isOpen_;      ///< of each piece that is the root of its component
    std::vector<int> component_;            ///< of each piece: number of its closed component or −1
    std::vector<int> blocks_;               ///< those that hold closed pieces
    std::vector<double> pieceSum_, pieceCells_, sum_, cells_;
    int closed_ = 0;
};

}  // namespace sim
