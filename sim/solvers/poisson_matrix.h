#pragma once

#include "sim/grid/block_grid.h"

namespace sim {

/// Dirichlet parts below this share of the diagonal are rounding of a row that has none.
inline constexpr double kDirichletRounding = 1.0e-12;

/// Symmetric M-matrix with a 7-point stencil on the cells of a BlockGrid. Row c reads
///     diagonal_c p_c − Σ over the six neighbours n of coupling_cn p_n.
/// A cell with diagonal 0 is no unknown. What the diagonal has more than the six couplings is the Dirichlet part, where
/// the pressure beyond the surface is 0; rows may not have less. The unit is the caller's.
///
/// One block is one contiguous piece: the diagonal, then for each axis the coupling (≥ 0) to the neighbour at −1 along
/// it, which is 0 unless both cells are unknowns. All 512 cells of each block must be set.
struct PoissonMatrix {
    BlockArray<double, 1 + kAxes> values;

    void resize(int blocks) { values.resize(blocks); }
    double* diagonal(int block) { return values.block(block, 0); }
    const double* diagonal(int block) const { return values.block(block, 0); }
    double* coupling(int axis, int block) { return values.block(block, 1 + axis); }
    const double* coupling(int axis, int block) const { return values.block(block, 1 + axis); }
};

}  // namespace sim
