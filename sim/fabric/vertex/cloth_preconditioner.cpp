#include "sim/fabric/vertex/cloth_preconditioner.h"

#include "sim/core/parallel.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cstring>

namespace sim {

namespace {

using ConstBlockRef = Eigen::Map<const Mat3>;

Mat3 blockAt(const AlignedArray<float>& blocks, int n)
{
    return Eigen::Map<const Eigen::Matrix3f>(blocks.data() + std::size_t{9} * n).cast<double>();
}

void store(const Mat3& block, AlignedArray<float>& blocks, int n)
{
    Eigen::Map<Eigen::Matrix3f>(blocks.data() + std::size_t{9} * n) = block.cast<float>();
}

/// A column of a block and a number more.
HalfPack columnAt(const float* block, int a)
{
    using Four = float __attribute__((vector_size(16)));
    Four four;
    std::memcpy(&four, block + 3 * a, sizeof four);
    return __builtin_convertvector(four, HalfPack);
}

/// B v; what is fourth is void.
HalfPack times(const float* block, const HalfPack& v) { return v[0] * columnAt(block, 0) + v[1] * columnAt(block, 1) + v[2] * columnAt(block, 2); }

/// Bᵀ v of a v whose fourth number is 0.
HalfPack transposedTimes(const float* block, const HalfPack& v)
{
    const HalfPack x = columnAt(block, 0) * v, y = columnAt(block, 1) * v, z = columnAt(block, 2) * v, none{};
    const HalfPack xy = __builtin_shufflevector(x, y, 0, 4, 2, 6) + __builtin_shufflevector(x, y, 1, 5, 3, 7);  // x01 y01 x23 y23
    const HalfPack z0 = __builtin_shufflevector(z, none, 0, 4, 2, 6) + __builtin_shufflevector(z, none, 1, 5, 3, 7);
    return __builtin_shufflevector(xy, z0, 0, 1, 4, 5) + __builtin_shufflevector(xy, z0, 2, 3, 6, 7);
}

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
    lower_.resize(9 * column_.size() + 1);
    inverse_.resize(std::size_t{9} * rows + 1);
    std::size_t longest = 0;
    for (int row = 0; row < rows; ++row) longest = std::max(longest, static_cast<std::size_t>(begin_[row + 1] - begin_[row]));
    unscaled_.assign(parts, std::vector<Mat3>(longest));
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
            Mat3* unscaled = unscaled_[part].data();
            const int begin = begin_[row];
            for (int e = begin; e < begin_[row + 1]; ++e) {
                const int c = column_[e];
                Mat3 u = ConstBlockRef(matrix.block(source_[e])).transpose();
                for (int i = begin, k = begin_[c]; i < e && k < begin_[c + 1];) {
                    if (column_[i] < column_[k]) ++i;
                    else if (column_[i] > column_[k]) ++k;
                    else u.noalias() -= unscaled[i++ - begin] * blockAt(lower_, k++).transpose();
                }
                unscaled[e - begin] = u;
            }
            for (int e = begin; e < begin_[row + 1]; ++e) {
                const Mat3 l = unscaled[e - begin] * blockAt(inverse_, column_[e]);
                pivot.noalias() -= l * unscaled[e - begin].transpose();
                store(l, lower_, e);
            }
            // Where too little is left of a pivot, the dropped fill has spoilt it, and L would grow from row to row.
            const bool isGood = Eigen::LLT<Mat3>(pivot - kLeastPivot * own).info() == Eigen::Success;
            const Mat3 inverse = (isGood ? pivot : own).inverse();
            store(0.5 * (inverse + inverse.transpose()), inverse_, row);
        }
    });
}

void ClothPreconditioner::solve(int part, const HalfPack* r, HalfPack* z) const
{
    const int first = partBegin_[part], last = partBegin_[part + 1];
    for (int row = first; row < last; ++row) {
        HalfPack v = r[row];
        for (int e = begin_[row]; e < begin_[row + 1]; ++e) v -= times(lower_.data() + std::size_t{9} * e, z[column_[e]]);
        z[row] = v;
    }
    for (int row = first; row < last; ++row) {
        HalfPack v = skipped_[row] ? HalfPack{} : times(inverse_.data() + std::size_t{9} * row, z[row]);
        v[3] = 0.0;
        z[row] = v;
    }
    for (int row = last - 1; row >= first; --row) {
        const HalfPack v = z[row];
        for (int e = begin_[row]; e < begin_[row + 1]; ++e) z[column_[e]] -= transposedTimes(lower_.data() + std::size_t{9} * e, v);
    }
}

}  // namespace sim
