#pragma once

#include "sim/solvers/block_rows.h"
#include "sim/solvers/poisson_matrix.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sim {

/// One grid of the hierarchy, in float. Rows without unknowns stay 0 in every vector.
struct MultigridLevel {
    /// Couplings are those inside a block; what crosses to the lower neighbour block is in `faces`, and 0 here.
    enum Kind { kInverse, kDiagonal, kCouplingX, kCouplingY, kCouplingZ, kKinds };

    BlockGrid grid;                              ///< grid of this level; on the finest only coordinates, from the lowest corner
    std::vector<std::array<int, 6>> neighbours;  ///< neighbours of each block at −x +x −y +y −z +z, and of the empty one
    std::array<std::vector<int>, 2> colour;      ///< blocks whose coordinates have an even and an odd sum
    std::vector<int> parent;                     ///< block of the next coarser level that each block is in
    std::vector<std::array<int, 8>> children;    ///< blocks of the next finer level in each block, or BlockGrid::kNone

    BlockArray<float, kKinds> matrix;  ///< 0 in cells that are no unknowns, the inverse of the diagonal too
    AlignedArray<float> faces;         ///< couplings across the three lower faces of each block, 64 each
    BlockArray<float> dirichlet;       ///< diagonal minus couplings
    BlockArray<float> x, r;            ///< unknown and right-hand side
    std::vector<std::uint64_t> rows;   ///< rows of each block that hold unknowns
    std::vector<double> dot;           ///< r·x of each block, of the finest level

    int blocks() const { return grid.count(); }
    float* face(int axis, int b) { return faces.data() + (b * std::size_t{kAxes} + axis) * kBlockRows; }
    const float* face(int axis, int b) const { return faces.data() + (b * std::size_t{kAxes} + axis) * kBlockRows; }
};

/// Approximate inverse of a PoissonMatrix, symmetric and positive definite (semi-definite where the matrix is): one
/// multigrid cycle in float.
///
/// Coarse cells are 2³ cells each, down to a single one. The transfer is piecewise constant; coarse coefficients are half
/// the sum of the fine ones, which makes up for it and is what discretising on the coarse cells would give.
/// Blocks are smoothed in two colours, like a chequerboard, so that a block meets only neighbours of the other colour:
/// in place, and the same bits for any number of threads. In a block: Gauss-Seidel with its cells in four colours.
/// After the coarse correction everything runs backwards, which makes the cycle symmetric.
class Multigrid {
 public:
    struct Options {
        int sweeps = 2;        ///< sweeps in each block before the coarse correction, and as many after it
        int coarseSweeps = 2;  ///< number of sweeps on levels of one block
        int firstTwice = 2;    ///< levels from this one visit the next twice, while they have several blocks
    };
    Options options;

    /// Take the coefficients; the shape of the hierarchy is kept while the set of blocks stays the same.
    void build(const BlockGrid& grid, const PoissonMatrix& matrix);

    /// Right-hand side of the cycle: 0 where the matrix has no unknown.
    BlockArray<float>& rightHandSide() { return levels_[0].r; }
    const BlockArray<float>& solution() const { return levels_[0].x; }
    BlockArray<float>& solution() { return levels_[0].x; }
    const MultigridLevel& finest() const { return levels_[0]; }

    /// solution = cycle applied to the right-hand side; returns their dot product.
    double cycle();

 private:
    void buildShape(const BlockGrid& grid);
    void cycle(int level, bool fromZero);

    std::vector<MultigridLevel> levels_;  ///< levels, of which the first count_ are in use
    std::vector<Vec3i> coords_;           ///< coordinates of the finest level's blocks, as given: tell whether the shape still fits
    std::vector<Vec3i> scratch_;
    int count_ = 0;
};

}  // namespace sim
