#include "sim/core/parallel.h"
#include "sim/solvers/multigrid_level.h"

namespace sim::multigrid {

namespace {

using Level = MultigridLevel;

/// Dirichlet parts below this share of the diagonal are rounding of a row that has none.
constexpr double kRounding = 1.0e-12;

/// Sum of the six couplings of each cell of row r.
template <class T>
Row<T> sumOfCouplings(const std::array<BlockCouplings<T>, 4>& c, int r)
{
    const int cell = r * kBlockEdge;
    const bool lastY = r % kBlockEdge == kBlockEdge - 1, lastZ = r / kBlockEdge == kBlockEdge - 1;
    const T* upY = lastY ? c[2].y + cell - kBlockEdge * (kBlockEdge - 1) : c[0].y + cell + kBlockEdge;
    const T* upZ = lastZ ? c[3].z + cell - kBlockRows * (kBlockEdge - 1) : c[0].z + cell + kBlockRows;
    const Row<T> x = loadRow(c[0].x + cell);
    return (x + upperAlongX<T>(x, c[1].x[cell])) + (loadRow(c[0].y + cell) + loadRow(upY)) +
           (loadRow(c[0].z + cell) + loadRow(upZ));
}

/// Diagonal and its inverse of one row; rows without unknowns get x = 0 and are not in the result.
bool finishRow(Level& level, int b, int r, Row<float> diagonal)
{
    const int c = r * kBlockEdge;
    const auto isUnknown = diagonal > 0.0f;
    const Row<float> one = {1, 1, 1, 1, 1, 1, 1, 1};
    storeRow<float>(level.matrix.block(b, Level::kDiagonal) + c, isUnknown ? diagonal : Row<float>{});
    storeRow<float>(level.matrix.block(b, Level::kInverse) + c, isUnknown ? one / (isUnknown ? diagonal : one) : Row<float>{});
    if (bitsOf(isUnknown) != 0) return true;
    storeRow(level.x.block(b) + c, Row<float>{});
    storeRow(level.r.block(b) + c, Row<float>{});
    return false;
}

/// A block's eighth of the couplings and Dirichlet parts of its parent.
void gatherChild(const Level& fine, int child, int corner, Level& coarse, int parent)
{
    const auto rowSum = [&](const float* p, bool bothY, bool bothZ) {
        Row<float> sum = loadRow(p);
        if (bothY) sum += loadRow(p + kBlockEdge);
        if (bothZ) sum += loadRow(p + kBlockRows);
        if (bothY && bothZ) sum += loadRow(p + kBlockRows + kBlockEdge);
        return sum;
    };
    const BlockCouplings<float> from = fine.couplings(child);
    const float* dirichlet = fine.dirichlet.block(child);
    for (int n = 0; n < 16; ++n) {
        const int j = n % 4, k = n / 4, f = cellInBlock(0, 2 * j, 2 * k), c = corner + cellInBlock(0, j, k);
        const Row<float> x = rowSum(from.x + f, true, true), y = rowSum(from.y + f, false, true);
        const Row<float> z = rowSum(from.z + f, true, false), d = rowSum(dirichlet + f, true, true);
        for (int i = 0; i < 4; ++i) {
            coarse.matrix.block(parent, Level::kCouplingX)[c + i] = 0.5f * x[2 * i];
            coarse.matrix.block(parent, Level::kCouplingY)[c + i] = 0.5f * (y[2 * i] + y[2 * i + 1]);
            coarse.matrix.block(parent, Level::kCouplingZ)[c + i] = 0.5f * (z[2 * i] + z[2 * i + 1]);
            coarse.dirichlet.block(parent)[c + i] = 0.5f * (d[2 * i] + d[2 * i + 1]);
        }
    }
}

void clearChild(Level& coarse, int parent, int corner)
{
    for (int n = 0; n < 16; ++n) {
        const int c = corner + cellInBlock(0, n % 4, n / 4);
        for (int kind = Level::kCouplingX; kind <= Level::kCouplingZ; ++kind)
            std::fill_n(coarse.matrix.block(parent, kind) + c, 4, 0.0f);
        std::fill_n(coarse.dirichlet.block(parent) + c, 4, 0.0f);
        std::fill_n(coarse.r.block(parent) + c, 4, 0.0f);
    }
}

}  // namespace

void takeFinest(const BlockGrid& grid, const PoissonMatrix& matrix, MultigridLevel& level)
{
    forEachBlock(level.blocks(), [&](int b) {
        const auto couplings = [&](int q) {
            return BlockCouplings<double>{matrix.coupling(0, q), matrix.coupling(1, q), matrix.coupling(2, q), nullptr};
        };
        const auto& around = grid.neighbours(b);
        const std::array<BlockCouplings<double>, 4> c = {couplings(b), couplings(around[14]), couplings(around[16]),
                                                         couplings(around[22])};
        const double* diagonal = matrix.diagonal(b);
        std::uint64_t rows = 0;
        float* right = level.rightCoupling.data() + b * std::size_t{kBlockRows};
        for (int r = 0; r < kBlockRows; ++r) {
            const int cell = r * kBlockEdge;
            const Row<double> d = loadRow(diagonal + cell), open = d - sumOfCouplings(c, r);
            storeRow(level.dirichlet.block(b) + cell, toFloat(open > kRounding * d ? open : Row<double>{}));
            const std::array<const double*, 3> lower = {c[0].x, c[0].y, c[0].z};
            for (int axis = 0; axis < kAxes; ++axis)
                storeRow(level.matrix.block(b, Level::kCouplingX + axis) + cell,
                         toFloat(loadRow(lower[axis] + cell)));
            right[r] = static_cast<float>(c[1].x[cell]);
            if (finishRow(level, b, r, toFloat(d))) rows |= std::uint64_t{1} << r;
        }
        level.rows[b] = rows;
    });
}

void gatherCoarse(const MultigridLevel& fine, MultigridLevel& coarse)
{
    forEachBlock(coarse.blocks(), [&](int b) {
        for (int n = 0; n < 8; ++n) {
            const int child = coarse.children[b][n], parent = b;
            const int corner = cellInBlock((n & 1) * 4, (n >> 1 & 1) * 4, (n >> 2) * 4);
            if (child == BlockGrid::kNone)
                clearChild(coarse, parent, corner);
            else
                gatherChild(fine, child, corner, coarse, parent);
        }
    });
    forEachBlock(coarse.blocks(), [&](int b) {
        const auto& around = coarse.neighbours[b];
        const std::array<BlockCouplings<float>, 4> c = {coarse.couplings(b), coarse.couplings(around[1]),
                                                        coarse.couplings(around[3]), coarse.couplings(around[5])};
        std::uint64_t rows = 0;
        float* right = coarse.rightCoupling.data() + b * std::size_t{kBlockRows};
        for (int r = 0; r < kBlockRows; ++r) {
            right[r] = c[1].x[r * kBlockEdge];
            const Row<float> d = loadRow(coarse.dirichlet.block(b) + r * kBlockEdge) + sumOfCouplings(c, r);
            if (finishRow(coarse, b, r, d)) rows |= std::uint64_t{1} << r;
        }
        coarse.rows[b] = rows;
    });
}

}  // namespace sim::multigrid
