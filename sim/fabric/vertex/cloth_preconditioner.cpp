#include "sim/fabric/vertex/cloth_preconditioner.h"

#include "sim/core/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>

namespace sim {

namespace {

using Block = Mat3;
using BlockRef = Eigen::Map<Block>;
using ConstBlockRef = Eigen::Map<const Block>;

constexpr int kParts = 16;            ///< parts of the rows at most that are worked on side by side
constexpr int kRowsPerPart = 2048;    ///< rows of a part at least: what parts leave out of the factor costs iterations
constexpr double kLeastPivot = 0.05;  ///< least pivot, relative to a row's own diagonal block [-]

}  // namespace

ClothPreconditioner::ClothPreconditioner(const BlockMatrix& matrix, const std::vector<std::vector<int>>& pattern, const std::vector<char>& isSkipped)
    : skipped_(isSkipped)
{
    const int rows = matrix.rows(), parts = std::clamp(rows / kRowsPerPart, 1, kParts);
    for (int part = 0; part <= parts; ++part) partBegin_.push_back(static_cast<int>(static_cast<long>(rows) * part / parts));
    begin_.push_back(0);
    droppedBegin_.push_back(0);
    for (int part = 0; part < parts; ++part)
        for (int row = partBegin_[part]; row < partBegin_[part + 1]; ++row) {
            for (int column : pattern[row]) {
                if (column < partBegin_[part] || column >= row || skipped_[column] || skipped_[row]) continue;
                column_.push_back(column);
                source_.push_back(matrix.find(column, row));
            }
            begin_.push_back(static_cast<int>(column_.size()));
            const auto isDropped = [&](int column) { return !std::ranges::binary_search(pattern[row], column); };
            for (const BlockMatrix::Mirror& m : matrix.left(row))
                if (isDropped(m.column)) dropped_.push_back(m.entry);
            for (int e = matrix.begin(row); e < matrix.begin(row + 1); ++e)
                if (isDropped(matrix.column(e))) dropped_.push_back(e);
            droppedBegin_.push_back(static_cast<int>(dropped_.size()));
        }
    lower_.resize(9 * column_.size());
    inverse_.resize(std::size_t{9} * rows);
}

void ClothPreconditioner::factor(const BlockMatrix& matrix, const std::vector<Mat3>& extra)
{
    parallelFor(parts(), [&](std::size_t part) {
        for (int row = partBegin_[part]; row < partBegin_[part + 1]; ++row) {
            if (skipped_[row]) continue;
            Mat3 own = ConstBlockRef(matrix.block(matrix.begin(row))) + extra[row];
            for (int d = droppedBegin_[row]; d < droppedBegin_[row + 1]; ++d) {
                const ConstBlockRef block(matrix.block(dropped_[d]));
                own += 0.5 * (block + block.transpose());
            }
            Mat3 pivot = own;
            // Up-looking: U(row, c) = A(row, c) − Σ U(row, k) L(c, k)ᵀ over the columns k that both rows have; L = U D⁻¹.
            for (int e = begin_[row]; e < begin_[row + 1]; ++e) {
                const int c = column_[e];
                Block u = ConstBlockRef(matrix.block(source_[e])).transpose();
                for (int i = begin_[row], k = begin_[c]; i < e && k < begin_[c + 1];) {
                    if (column_[i] < column_[k]) ++i;
                    else if (column_[i] > column_[k]) ++k;
                    else u.noalias() -= BlockRef(lower_.data() + 9 * i++) * BlockRef(lower_.data() + 9 * k++).transpose();
                }
                BlockRef(lower_.data() + 9 * e) = u;
            }
            for (int e = begin_[row]; e < begin_[row + 1]; ++e) {
                const Block u = BlockRef(lower_.data() + 9 * e);
                BlockRef l(lower_.data() + 9 * e);
                l.noalias() = u * BlockRef(inverse_.data() + 9 * column_[e]);
                pivot.noalias() -= l * u.transpose();
            }
            // Where too little is left of a pivot, the dropped fill has spoilt it, and L would grow from row to row.
            const bool isGood = Eigen::LLT<Mat3>(pivot - kLeastPivot * own).info() == Eigen::Success;
            BlockRef(inverse_.data() + 9 * row) = (isGood ? pivot : own).inverse();
        }
    });
}

void ClothPreconditioner::solve(int part, const double* r, double* z) const
{
    using Column = Eigen::Map<Vec3>;
    using ConstColumn = Eigen::Map<const Vec3>;
    const int first = partBegin_[part], last = partBegin_[part + 1];
    for (int row = first; row < last; ++row) {
        Vec3 v = ConstColumn(r + 3 * row);
        for (int e = begin_[row]; e < begin_[row + 1]; ++e) v.noalias() -= ConstBlockRef(lower_.data() + 9 * e) * ConstColumn(z + 3 * column_[e]);
        Column(z + 3 * row) = v;
    }
    for (int row = first; row < last; ++row) {
        if (skipped_[row]) Column(z + 3 * row).setZero();
        else Column(z + 3 * row) = (ConstBlockRef(inverse_.data() + 9 * row) * ConstColumn(z + 3 * row)).eval();
    }
    for (int row = last - 1; row >= first; --row) {
        const Vec3 v = Column(z + 3 * row);
        for (int e = begin_[row]; e < begin_[row + 1]; ++e)
            Column(z + 3 * column_[e]).noalias() -= ConstBlockRef(lower_.data() + 9 * e).transpose() * v;
    }
}

}  // namespace sim
