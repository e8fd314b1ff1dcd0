#include "sim/solvers/components.h"

#include "sim/core/parallel.h"
#include "sim/solvers/block_rows.h"

#include <algorithm>

namespace sim {

namespace {

bool isEmpty(CellSet s) { return rowsOf(s) == 0; }

/// What a block's couplings say about which cells hang together.
struct BlockBonds {
    CellSet unknown = {}, open = {};
    std::array<CellSet, kAxes> lower = {};  ///< cells coupled to their lower neighbour in the same block
};

BlockBonds bondsOf(int b, const BlockGrid& grid, const PoissonMatrix& matrix)
{
    const auto& around = grid.neighbours(b);
    const double *diagonal = matrix.diagonal(b), *x = matrix.coupling(0, b), *beyondX = matrix.coupling(0, around[kBlockAbove[0]]);
    const double *y = matrix.coupling(1, b), *beyondY = matrix.coupling(1, around[kBlockAbove[1]]);
    const double *z = matrix.coupling(2, b), *beyondZ = matrix.coupling(2, around[kBlockAbove[2]]);
    BlockBonds bonds;
    for (int r = 0; r < kBlockRows; ++r) {
        const int c = r * kBlockEdge, j = r % kBlockEdge, k = r / kBlockEdge;
        const Row<double> d = loadRow(diagonal + c), lowX = loadRow(x + c), lowY = loadRow(y + c), lowZ = loadRow(z + c);
        const Row<double> upX = upperAlongX<double>(lowX, beyondX[c]);
        const Row<double> upY = loadRow(j < kBlockEdge - 1 ? y + c + kBlockEdge : beyondY + c - (kBlockRows - kBlockEdge));
        const Row<double> upZ = loadRow(k < kBlockEdge - 1 ? z + c + kBlockRows : beyondZ + c - (kBlockCells - kBlockRows));
        const Row<double> open = d - ((lowX + upX) + (lowY + upY) + (lowZ + upZ));
        bonds.unknown |= cellsOfRow(d > 0.0, r);
        bonds.open |= cellsOfRow((d > 0.0) & (open > kDirichletRounding * d), r);
        bonds.lower[0] |= cellsOfRow(lowX > 0.0, r);
        if (j > 0) bonds.lower[1] |= cellsOfRow(lowY > 0.0, r);
        if (k > 0) bonds.lower[2] |= cellsOfRow(lowZ > 0.0, r);
    }
    bonds.lower[0][0] = 0;
    return bonds;
}

/// The set grown along one axis, up and down, as far as the bonds go. A whole row in three
/// strides of 1, 2 and 4: bonds over a stride are those over its halves.
template <class Up, class Down>
CellSet spread(CellSet set, CellSet bonds, const Up& up, const Down& down)
{
    CellSet upper = set, lower = set, bondsUp = bonds, bondsDown = down(bonds, 1);
    for (int stride : {1, 2, 4}) {
        upper |= up(upper, stride) & bondsUp;
        lower |= down(lower, stride) & bondsDown;
        bondsUp &= up(bondsUp, stride);
        bondsDown &= down(bondsDown, stride);
    }
    return upper | lower;
}

/// All cells that hang together with those of the set.
CellSet flood(CellSet set, const BlockBonds& bonds)
{
    const CellSet none = {};
    const auto upX = [&](CellSet s, int n) {
        if (n == 1) return CellSet(__builtin_shufflevector(s, none, 8, 0, 1, 2, 3, 4, 5, 6));
        if (n == 2) return CellSet(__builtin_shufflevector(s, none, 8, 8, 0, 1, 2, 3, 4, 5));
        return CellSet(__builtin_shufflevector(s, none, 8, 8, 8, 8, 0, 1, 2, 3));
    };
    const auto downX = [&](CellSet s, int n) {
        if (n == 1) return CellSet(__builtin_shufflevector(s, none, 1, 2, 3, 4, 5, 6, 7, 8));
        if (n == 2) return CellSet(__builtin_shufflevector(s, none, 2, 3, 4, 5, 6, 7, 8, 8));
        return CellSet(__builtin_shufflevector(s, none, 4, 5, 6, 7, 8, 8, 8, 8));
    };
    const auto upY = [](CellSet s, int n) { return s << n; };
    const auto downY = [](CellSet s, int n) { return s >> n; };
    const auto upZ = [](CellSet s, int n) { return s << kBlockEdge * n; };
    const auto downZ = [](CellSet s, int n) { return s >> kBlockEdge * n; };
    for (;;) {
        CellSet grown = spread(set, bonds.lower[0], upX, downX);
        grown = spread(grown, bonds.lower[1], upY, downY);
        grown = spread(grown, bonds.lower[2], upZ, downZ);
        if (isEmpty(grown & ~set)) return set;
        set = grown;
    }
}

/// Labels of the cells of a block that is one piece.
void labelSinglePiece(CellSet unknown, std::uint16_t noLabel, std::uint16_t* label)
{
    using Labels = Row<std::uint16_t>;
    for (int r = 0; r < kBlockRows; ++r) {
        const Labels isIn = __builtin_convertvector(unknown >> r & 1, Labels);
        storeRow<std::uint16_t>(label + r * kBlockEdge, noLabel * (1 - isIn));
    }
}

/// One cell of the set, as a set.
CellSet oneOf(CellSet set)
{
    CellSet one = {};
    for (int i = 0; i < kBlockEdge; ++i)
        if (set[i] != 0) {
            one[i] = set[i] & (~set[i] + 1);
            return one;
        }
    return one;
}

}  // namespace

int ConnectedComponents::labelBlock(int b, const BlockGrid& grid, const PoissonMatrix& matrix)
{
    const BlockBonds bonds = bondsOf(b, grid, matrix);
    std::uint16_t* label = label_.block(b);
    const CellSet first = flood(oneOf(bonds.unknown), bonds);
    if (isEmpty(bonds.unknown & ~first)) {
        isOpenLocal_.block(b)[0] = !isEmpty(first & bonds.open);
        labelSinglePiece(first, kNoLabel, label);
        return isEmpty(first) ? 0 : 1;
    }
    std::fill_n(label, kBlockCells, kNoLabel);
    int pieces = 0;
    for (CellSet rest = bonds.unknown; !isEmpty(rest); ++pieces) {
        const CellSet piece = flood(oneOf(rest), bonds);
        rest &= ~piece;
        isOpenLocal_.block(b)[pieces] = !isEmpty(piece & bonds.open);
        for (int i = 0; i < kBlockEdge; ++i) forEachRow(piece[i], [&](int r) { label[r * kBlockEdge + i] = static_cast<std::uint16_t>(pieces); });
    }
    return pieces;
}

int ConnectedComponents::root(int piece)
{
    while (parent_[piece] != piece) piece = parent_[piece] = parent_[parent_[piece]];
    return piece;
}

void ConnectedComponents::join(int a, int b)
{
    const int ra = root(a), rb = root(b), first = std::min(ra, rb);
    parent_[ra] = parent_[rb] = first;
    isOpen_[first] = isOpen_[ra] | isOpen_[rb];
}

void ConnectedComponents::joinBlocks(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    constexpr std::array<int, kAxes> kStep = {1, kBlockEdge, kBlockRows};
    for (int b = 0; b < grid.count(); ++b)
        for (int axis = 0; axis < kAxes; ++axis) {
            const int lower = grid.neighbours(b)[neighbourIndex(-(axis == 0), -(axis == 1), -(axis == 2))];
            if (lower == grid.count()) continue;
            const bool isSimple = first_[b + 1] - first_[b] == 1 && first_[lower + 1] - first_[lower] == 1;
            const double* coupling = matrix.coupling(axis, b);
            const int u = kStep[(axis + 1) % kAxes], v = kStep[(axis + 2) % kAxes];
            for (int n = 0; n < kBlockRows; ++n) {
                const int c = n % kBlockEdge * u + n / kBlockEdge * v;
                if (!(coupling[c] > 0.0)) continue;
                join(first_[b] + label_.block(b)[c], first_[lower] + label_.block(lower)[c + (kBlockEdge - 1) * kStep[axis]]);
                if (isSimple) break;
            }
        }
}

void ConnectedComponents::numberComponents()
{
    closed_ = all_ = 0;
    blocks_.clear();
    const int blocks = static_cast<int>(first_.size()) - 1;
    for (int b = 0; b < blocks; ++b) {
        bool any = false;
        for (int p = first_[b]; p < first_[b + 1]; ++p) {
            const int r = root(p);  // the smallest number of its component: met before all others
            component_[p] = isOpen_[r] ? -1 : r == p ? closed_++ : component_[r];
            number_[p] = r == p ? all_++ : number_[r];
            any = any || component_[p] >= 0;
        }
        if (any) blocks_.push_back(b);
    }
    sum_.resize(closed_);
    cells_.resize(closed_);
}

int ConnectedComponents::ofBlock(int b) const
{
    const auto begin = number_.begin() + first_[b], end = number_.begin() + first_[b + 1];
    if (begin == end) return -1;
    return std::all_of(begin, end, [&](int number) { return number == *begin; }) ? *begin : kSeveral;
}

void ConnectedComponents::find(const BlockGrid& grid, const PoissonMatrix& matrix)
{
    const int n = grid.count();
    label_.resize(n);
    isOpenLocal_.resize(n);
    first_.resize(n + 1);
    first_[0] = 0;
    forEachBlock(n, [&](int b) { first_[b + 1] = labelBlock(b, grid, matrix); });
    for (int b = 0; b < n; ++b) first_[b + 1] += first_[b];

    parent_.resize(first_[n]);
    isOpen_.resize(first_[n]);
    component_.resize(first_[n]);
    number_.resize(first_[n]);
    pieceSum_.resize(first_[n]);
    pieceCells_.resize(first_[n]);
    for (int b = 0; b < n; ++b)
        for (int p = first_[b]; p < first_[b + 1]; ++p) {
            parent_[p] = p;
            isOpen_[p] = isOpenLocal_.block(b)[p - first_[b]];
        }
    joinBlocks(grid, matrix);
    numberComponents();
}

template <class T>
void ConnectedComponents::removeMeans(BlockArray<T>& v)
{
    if (closed_ == 0) return;
    forEachBlock(static_cast<int>(blocks_.size()), [&](int n) {
        const int b = blocks_[n];
        for (int p = first_[b]; p < first_[b + 1]; ++p) pieceSum_[p] = pieceCells_[p] = 0.0;
        const std::uint16_t* label = label_.block(b);
        const T* x = v.block(b);
        for (int c = 0; c < kBlockCells; ++c) {
            if (label[c] == kNoLabel) continue;
            pieceSum_[first_[b] + label[c]] += static_cast<double>(x[c]);
            pieceCells_[first_[b] + label[c]] += 1.0;
        }
    });
    std::fill(sum_.begin(), sum_.end(), 0.0);
    std::fill(cells_.begin(), cells_.end(), 0.0);
    for (int b : blocks_)
        for (int p = first_[b]; p < first_[b + 1]; ++p) {
            if (component_[p] < 0) continue;
            sum_[component_[p]] += pieceSum_[p];
            cells_[component_[p]] += pieceCells_[p];
        }
    forEachBlock(static_cast<int>(blocks_.size()), [&](int n) {
        const int b = blocks_[n];
        const std::uint16_t* label = label_.block(b);
        T* x = v.block(b);
        for (int c = 0; c < kBlockCells; ++c) {
            const int component = label[c] == kNoLabel ? -1 : component_[first_[b] + label[c]];
            if (component >= 0) x[c] -= static_cast<T>(sum_[component] / cells_[component]);
        }
    });
}

template void ConnectedComponents::removeMeans(BlockArray<float>&);
template void ConnectedComponents::removeMeans(BlockArray<double>&);

}  // namespace sim
