#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/types.h"
#include "sim/fabric/block_matrix.h"

#include <vector>

namespace sim {

/// Incomplete block Cholesky factors with a given pattern, of each of a fixed number of ranges of rows by itself, so that they can be
/// worked on side by side: the result does not depend on the number of threads.
class ClothPreconditioner {
 public:
    ClothPreconditioner() = default;
    /// `pattern`: columns of each row, ascending, all of them in the matrix; what the matrix has beside them is added to the
    /// diagonal. `isSkipped` rows are left out.
    ClothPreconditioner(const BlockMatrix& matrix, const std::vector<std::vector<int>>& pattern, const std::vector<char>& isSkipped);

    /// Factors `matrix` with `extra` (one symmetric block per row) added to its diagonal. A row whose pivot is not positive definite is
    /// scaled by its own diagonal block alone.
    void factor(const BlockMatrix& matrix, const std::vector<Mat3>& extra);
    int parts() const { return static_cast<int>(partBegin_.size()) - 1; }
    int partBegin(int part) const { return partBegin_[part]; }
    /// z = (L D Lᵀ)⁻¹ r for the rows of a part; one 3-vector per row.
    void solve(int part, const double* r, double* z) const;

 private:
    std::vector<int> partBegin_;
    std::vector<char> skipped_;
    std::vector<int> begin_, column_, source_;  ///< strictly lower blocks by row: column, and where the transpose stands in the matrix
    std::vector<int> droppedBegin_, dropped_;   ///< blocks that are not in the pattern, or their transposes, by row
    AlignedArray<double> lower_;                ///< L, 9 per block
    AlignedArray<double> inverse_;              ///< D⁻¹, 9 per row
};

}  // namespace sim
