#include "sim/liquid/curvature.h"

#include "sim/core/parallel.h"
#include "sim/liquid/smooth_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace sim {

namespace {

constexpr double kPassVariance = 1.0 / 3.0;  ///< [cells²]
/// Variance that B-splines and the mean over a cell's faces give the fill along each axis: 1/4 + 1/3 · 1/4 [cells²].
constexpr double kFillVariance = 1.0 / 3.0;
/// And what the differences of colours and of normals are worth: (1 + Δ/6) ∂ each [cells²].
constexpr double kDifferenceVariance = 2.0 / 3.0;
/// Added to |∇c| where normals are found, so that the middle of films and flat liquid have none [1/cell]. At a surface
/// ∇c is at least ten times as large.
constexpr double kLeastSlope = 0.01;

}  // namespace

template <class Body>
void Curvature::forEachActive(Body&& body) const
{
    parallelFor(active_.size(), 2, [&](std::size_t n) { body(active_[n]); });
}

void Curvature::fitTo(const BlockGrid& grid)
{
    band_.dx = grid.dx;
    band_.origin = grid.origin;
    if (liquidCoords_ == grid.coords()) return;
    liquidCoords_ = grid.coords();
    coords_.clear();
    for (const Vec3i& c : liquidCoords_)
        for (int n = 0; n < 27; ++n) coords_.push_back(c + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
    const auto before = [](const Vec3i& a, const Vec3i& b) { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); };
    std::sort(coords_.begin(), coords_.end(), before);
    coords_.erase(std::unique(coords_.begin(), coords_.end()), coords_.end());
    band_.setBlocks(coords_);

    const int count = band_.count();
    bandBlock_.resize(static_cast<std::size_t>(grid.count()));
    liquidBlock_.assign(static_cast<std::size_t>(count), BlockGrid::kNone);
    for (int b = 0; b < grid.count(); ++b) {
        bandBlock_[b] = band_.find(grid.coords(b));
        liquidBlock_[bandBlock_[b]] = b;
    }
    isActive_.resize(static_cast<std::size_t>(count));
    active_.reserve(static_cast<std::size_t>(count));
    for (BlockBits<>* bits : {&wall_, &known_, &fresh_, &surface_, &beside_, &around_}) bits->resize(count);
    for (BlockArray<double>* field : {&colour_, &other_, &smooth_, &curvature_}) field->resize(count);
    normal_.resize(count);
}

/// Cells that are deep, and so far from those that are not that B-splines reach no air along any direction, are full:
/// what P2G found there differs from that by the noise of the particles' places only.
void Curvature::takeFill(const ObstacleField& obstacles, const LiquidGrid& liquid)
{
    const auto forEachBlock = [&](auto&& body) {
        parallelFor(static_cast<std::size_t>(band_.count()), 4, [&](std::size_t b) { body(static_cast<int>(b), liquidBlock_[b]); });
    };
    const auto isThere = [](int from) { return from != BlockGrid::kNone; };
    forEachBlock([&](int b, int from) {
        for (int k = 0; k < kBlockEdge; ++k) {
            wall_.block(b)[k] = isThere(from) ? obstacles.blocked(from)[k] : 0;
            surface_.block(b)[k] = isThere(from) ? liquid.surface.block(from)[k] : 0;
            fresh_.block(b)[k] = isThere(from) ? ~(liquid.deep.block(from)[k] | wall_.block(b)[k]) : ~std::uint64_t{0};
        }
    });
    forEachBlock([&](int b, int) { dilate(band_, b, 0, kAxes, fresh_, known_); });
    forEachBlock([&](int b, int) { dilate(band_, b, 0, kAxes, known_, fresh_); });
    forEachBlock([&](int b, int from) {
        for (int row = 0; row < kBlockCells; row += kLanes) {
            Pack fill = broadcast(0.0);
            if (isThere(from)) {
                const PackMask nearAir = maskOfBits(fresh_.block(b)[row >> 6] >> (row & 63));
                fill = select(nearAir, loadPack(liquid.fill.block(from) + row), broadcast(1.0));
            }
            storePack(colour_.block(b) + row, fill);
            storePack(other_.block(b) + row, fill);
        }
    });
    forEachBlock([&](int b, int) {
        for (BlockBits<>* bits : {&known_, &fresh_, &beside_, &around_}) std::fill_n(bits->block(b), BlockBits<>::kWords, 0);
    });
}

void Curvature::findActive()
{
    const auto any = [](const std::uint64_t* words) { return std::any_of(words, words + kBlockEdge, [](std::uint64_t w) { return w != 0; }); };
    std::fill(isActive_.begin(), isActive_.end(), std::uint8_t{0});
    active_.clear();
    hasWalls_ = false;
    for (int b = 0; b < band_.count(); ++b) {
        hasWalls_ = hasWalls_ || any(wall_.block(b));
        if (!any(surface_.block(b))) continue;
        for (const int near : band_.neighbours(b))
            if (near < band_.count()) isActive_[near] = 1;
    }
    for (int b = 0; b < band_.count(); ++b)
        if (isActive_[b]) active_.push_back(b);
}

void Curvature::smoothOnce()
{
    const BlockBits<>* wall = hasWalls_ ? &wall_ : nullptr;
    for (int a = 0; a < kAxes; ++a) {
        forEachActive([&](int b) {
            const SidesInBlock block(band_, b, colour_, wall);
            for (int k = 0; k < kBlockEdge; ++k)
                for (int j = 0; j < kBlockEdge; ++j) {
                    const Pack own = block.own(j, k);
                    const Sides sides = block.along(a, j, k, own);
                    storePack(other_.block(b) + cellInBlock(0, j, k), kSide * (sides.below + sides.above) + kMiddle * own);
                }
        });
        colour_.swap(other_);
    }
}

/// c − v Δc, with Δ = 2 (pass − 1) / (variance of a pass). A kernel G moves a curved surface by its second moment over
/// the plane that touches the surface; that of G − v ΔG is 0 where v is the variance of G.
void Curvature::sharpen(double variance)
{
    forEachActive([&](int b) { std::copy_n(colour_.block(b), kBlockCells, smooth_.block(b)); });
    smoothOnce();
    const double share = 2.0 * variance / kPassVariance;
    forEachActive([&](int b) {
        for (int row = 0; row < kBlockCells; row += kLanes) {
            const Pack before = loadPack(smooth_.block(b) + row);
            storePack(colour_.block(b) + row, before + share * (before - loadPack(colour_.block(b) + row)));
        }
    });
}

/// Values for the cells of walls behind the first liquid or air: take(cell, neighbours in front, how many, their axes),
/// then in edges and corners. Each sweep reads what was known before it.
template <class Take>
void Curvature::mirrorAtWalls(Take&& take)
{
    if (!hasWalls_) return;
    parallelFor(static_cast<std::size_t>(band_.count()), 8, [&](std::size_t b) {
        for (int k = 0; k < kBlockEdge; ++k) known_.block(static_cast<int>(b))[k] = ~wall_.block(static_cast<int>(b))[k];
    });
    for (int sweep = 0; sweep < kAxes; ++sweep) {
        forEachActive([&](int b) {
            dilate(band_, b, 0, kAxes, known_, fresh_);
            for (int k = 0; k < kBlockEdge; ++k) {
                fresh_.block(b)[k] &= ~known_.block(b)[k];
                for (std::uint64_t left = fresh_.block(b)[k]; left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const Vec3i cell(bit & 7, bit >> 3, k);
                    std::array<CellRef, 6> front;
                    std::array<int, 6> axes;
                    int count = 0;
                    for (int side = 0; side < 6; ++side) {
                        const Vec3i to = cell + (2 * (side & 1) - 1) * Vec3i::Unit(side >> 1);
                        const CellRef ref = cellNear(band_, b, to.x(), to.y(), to.z());
                        if (!known_.test(ref.block, ref.cell)) continue;
                        front[count] = ref;
                        axes[count++] = side >> 1;
                    }
                    take(CellRef{b, cellInBlock(cell.x(), cell.y(), k)}, front, count, axes);
                }
            }
        });
        forEachActive([&](int b) {
            for (int k = 0; k < kBlockEdge; ++k) known_.block(b)[k] |= fresh_.block(b)[k];
        });
    }
}

void Curvature::findNormals()
{
    mirrorAtWalls([&](const CellRef& cell, const std::array<CellRef, 6>& front, int count, const std::array<int, 6>&) {
        double sum = 0.0;
        for (int i = 0; i < count; ++i) sum += colour_.block(front[i].block)[front[i].cell];
        colour_.block(cell.block)[cell.cell] = sum / count;
    });
    forEachActive([&](int b) { dilate(band_, b, 0, kAxes, surface_, beside_); });
    forEachActive([&](int b) { dilate(band_, b, 0, 1, beside_, around_); });
    forEachActive([&](int b) { dilate(band_, b, 1, 2, around_, fresh_); });
    forEachActive([&](int b) { dilate(band_, b, 2, 3, fresh_, around_); });
    forEachActive([&](int b) {
        const int* neighbours = band_.neighbours(b).data();
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                if ((around_.block(b)[k] >> (j * kBlockEdge) & 0xff) == 0) continue;
                const int row = cellInBlock(0, j, k);
                const Slope slope = slopeOfRow(RowsAround<1>{colour_, 0, neighbours}, j, k);
                const Pack square = slope.x * slope.x + slope.y * slope.y + slope.z * slope.z;
                const Pack scale = -1.0 / sqrtPack(square + kLeastSlope * kLeastSlope);
                storePack(normal_.block(b, 0) + row, scale * slope.x);
                storePack(normal_.block(b, 1) + row, scale * slope.y);
                storePack(normal_.block(b, 2) + row, scale * slope.z);
            }
    });
    mirrorAtWalls([&](const CellRef& cell, const std::array<CellRef, 6>& front, int count, const std::array<int, 6>& axes) {
        for (int a = 0; a < kAxes; ++a) {
            double sum = 0.0;
            for (int i = 0; i < count; ++i) sum += (axes[i] == a ? -1.0 : 1.0) * normal_.block(front[i].block, a)[front[i].cell];
            normal_.block(cell.block, a)[cell.cell] = sum / count;
        }
    });
}

void Curvature::findDivergence()
{
    forEachActive([&](int b) {
        const int* neighbours = band_.neighbours(b).data();
        for (int k = 0; k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                if ((beside_.block(b)[k] >> (j * kBlockEdge) & 0xff) == 0) continue;
                const Slope x = slopeOfRow(RowsAround<3>{normal_, 0, neighbours}, j, k), y = slopeOfRow(RowsAround<3>{normal_, 1, neighbours}, j, k),
                            z = slopeOfRow(RowsAround<3>{normal_, 2, neighbours}, j, k);
                storePack(curvature_.block(b) + cellInBlock(0, j, k), x.x + y.y + z.z);
            }
    });
}

void Curvature::find(const CutGrid& cut, const SurfaceCells& cells, int passes)
{
    fitTo(cut.grid);
    takeFill(cut.field, cells.liquid());
    findActive();
    for (int pass = 0; pass < passes; ++pass) smoothOnce();
    sharpen(kFillVariance + kDifferenceVariance + kPassVariance * passes);
    findNormals();
    findDivergence();
}

double Curvature::between(int block, const Vec3i& liquidCell, const Vec3i& airCell) const
{
    const Vec3i inwards = liquidCell - airCell;
    const auto at = [&](const Vec3i& cell) { return cellNear(band_, bandBlock_[block], cell.x(), cell.y(), cell.z()); };
    const auto colour = [&](const CellRef& ref) { return colour_.block(ref.block)[ref.cell]; };
    const auto kappa = [&](const CellRef& ref) { return curvature_.block(ref.block)[ref.cell]; };
    // A liquid cell's middle may be half a cell above the surface.
    CellRef outer = at(airCell), inner = at(liquidCell);
    const CellRef next = at(liquidCell + inwards);
    if (colour(inner) < 0.5 && colour(next) > colour(inner) && !wall_.test(next.block, next.cell)) outer = std::exchange(inner, next);
    const double step = colour(inner) - colour(outer);
    const double way = step > 0.0 ? std::clamp((0.5 - colour(outer)) / step, 0.0, 1.0) : 0.5;
    constexpr double kLargest = 2.0;
    return std::clamp(kappa(outer) + way * (kappa(inner) - kappa(outer)), -kLargest, kLargest) / band_.dx;
}

}  // namespace sim
