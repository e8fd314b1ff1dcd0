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
    /// z = (L D Lᵀ)⁻¹ r for the rows of a part; three numbers and a 0 per row.
    void solve(int part, const HalfPack* r, HalfPack* z) const;

 private:
    std::vector<int> partBegin_;
    std::vector<char> skipped_;
    std::vector<int> begin_, column_, source_;  ///< strictly lower blocks by row: column, and where the transpose stands in the matrix
    std::vector<int> droppedBegin_, dropped_;   ///< blocks that are not in the pattern, or their transposes, by row
    // Rounded: what is left out of the factor is more. Behind the last block one number more may be read.
    AlignedArray<float> lower_;                ///< L, 9 per block
    AlignedArray<float> inverse_;              ///< D⁻¹, 9 per row
    std::vector<std::vector<Mat3>> unscaled_;  ///< L D of the row that each part works on
};

}  // namespace sim
