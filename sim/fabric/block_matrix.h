#pragma once

#include "sim/core/aligned_array.h"

#include <span>
#include <vector>

namespace sim {

/// A symmetric matrix of 3x3 blocks with a fixed pattern, rows of all blocks stored (block CSR). Blocks are
/// column-major; behind the last one number more may be read.
class BlockMatrix {
 public:
    BlockMatrix() = default;
    /// Rows with ascending columns; the diagonal must be among them.
    explicit BlockMatrix(const std::vector<std::vector<int>>& columns);

    int rows() const { return static_cast<int>(begin_.size()) - 1; }
    int begin(int row) const { return begin_[row]; }
    int column(int entry) const { return column_[entry]; }
    int diagonal(int row) const { return diagonal_[row]; }
    /// Where the block of a row and a column stands; both must be in the pattern.
    int find(int row, int column) const;
    double* block(int entry) { return values_.data() + std::size_t{9} * entry; }
    const double* block(int entry) const { return values_.data() + std::size_t{9} * entry; }
    void clear() { values_.fill(0.0); }

 private:
    std::vector<int> begin_ = {0};
    std::vector<int> column_, diagonal_;
    AlignedArray<double> values_;
};

}  // namespace sim
