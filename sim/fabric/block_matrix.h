#pragma once

#include "sim/core/aligned_array.h"
#include "sim/core/simd.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

namespace sim {

/// A symmetric matrix of 3x3 blocks with a fixed pattern. Rows begin with their diagonal block; what is left of it is read where its
/// transpose stands (block CSR of the upper half). Blocks are column-major; behind the last one number more may be read.
class BlockMatrix {
 public:
    /// A block left of the diagonal: its column, and the entry of its transpose.
    struct Mirror {
        int column, entry;
    };

    BlockMatrix() = default;
    /// Rows with ascending columns; the diagonal must be among them, and with every block its transpose.
    explicit BlockMatrix(const std::vector<std::vector<int>>& columns);

    int rows() const { return static_cast<int>(begin_.size()) - 1; }
    /// The diagonal block of a row, then those right of it up to begin(row + 1).
    int begin(int row) const { return begin_[row]; }
    int column(int entry) const { return column_[entry]; }
    std::span<const Mirror> left(int row) const { return {mirrors_.data() + mirrorBegin_[row], mirrors_.data() + mirrorBegin_[row + 1]}; }
    /// Where the block of a row and a column ≥ row stands; it must be in the pattern.
    int find(int row, int column) const;
    double* block(int entry) { return values_.data() + std::size_t{9} * entry; }
    const double* block(int entry) const { return values_.data() + std::size_t{9} * entry; }
    void clear() { values_.fill(0.0); }

    /// Rows of the product that are found together: most blocks tie two of them and are read once.
    static constexpr int kRowsAtOnce = 512;
    int chunks() const { return (rows() + kRowsAtOnce - 1) / kRowsAtOnce; }
    /// give(row, product) for each row of a chunk, in ascending order, of the product with a vector of which at(column) gives the three
    /// numbers and a 0; the fourth that comes out is void.
    template <class At, class Give>
    void timesChunk(int chunk, At&& at, Give&& give) const
    {
        struct Columns {
            HalfPack x, y, z;  ///< whose sums are the three numbers
        };
        const int first = chunk * kRowsAtOnce, last = std::min(first + kRowsAtOnce, rows());
        const auto of = [&](int entry, int from) {
            HalfPack column;  // at any multiple of 8 bytes, which clang forgets of a HalfPack that is pointed to
            std::memcpy(&column, block(entry) + from, sizeof column);
            return column;
        };
        const auto sum = [](const HalfPack& v) { return v[0] + v[1] + v[2]; };
        const auto addTransposed = [&](Columns& to, int entry, const HalfPack& u) {
            to.x += u * of(entry, 0), to.y += u * of(entry, 3), to.z += u * of(entry, 6);
        };
        Columns left[kRowsAtOnce];
        std::fill_n(left, last - first, Columns{});
        for (int row = first; row < last; ++row) {
            const HalfPack own = at(row);
            HalfPack right{};
            for (int e = begin_[row]; e < begin_[row + 1]; ++e) {
                const HalfPack u = at(column_[e]);
                right += u[0] * of(e, 0) + u[1] * of(e, 3) + u[2] * of(e, 6);
                if (e > begin_[row] && column_[e] < last) addTransposed(left[column_[e] - first], e, own);
            }
            Columns& before = left[row - first];
            for (int m = mirrorBegin_[row]; m < mirrorBegin_[row + 1] && mirrors_[m].column < first; ++m)
                addTransposed(before, mirrors_[m].entry, at(mirrors_[m].column));
            give(row, right + HalfPack{sum(before.x), sum(before.y), sum(before.z), 0.0});
        }
    }

 private:
    std::vector<int> begin_ = {0}, mirrorBegin_ = {0};
    std::vector<int> column_;
    std::vector<Mirror> mirrors_;
    AlignedArray<double> values_;
};

}  // namespace sim
