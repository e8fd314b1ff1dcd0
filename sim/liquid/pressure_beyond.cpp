#include "sim/liquid/pressure_beyond.h"

#include "sim/core/parallel.h"
#include "sim/grid/rows.h"

#include <algorithm>
#include <atomic>

namespace sim {

namespace {

constexpr double kSteepest = 0.5;  ///< slope, from that at rest, that the surface is taken to have at most [-]

/// Keeps what there is, which is 0, and makes what is new so.
template <class T, int kKinds>
void resizeZero(BlockArray<T, kKinds>& field, int blocks)
{
    const std::size_t known = field.size();
    field.resize(blocks);
    if (field.size() > known) std::fill_n(field.block(0) + known, field.size() - known, T{});
}

template <class T, int kKinds>
void clearBlock(BlockArray<T, kKinds>& field, int block)
{
    std::fill_n(field.block(block), BlockArray<T, kKinds>::kStride, T{});
}

/// A row of 8 cells, and the rows one cell further along an axis.
struct RowsAlong {
    RowAccess rows;
    int j, k, axis, step;  ///< place of the row; the axis, and 1 or -1

    template <class T, int kKinds>
    Pack here(const BlockArray<T, kKinds>& field, int kind) const
    {
        return rows.row(field, kind, j, k);
    }
    template <class T, int kKinds>
    Pack further(const BlockArray<T, kKinds>& field, int kind) const
    {
        return step > 0 ? rows.above(field, kind, axis, j, k) : rows.below(field, kind, axis, j, k);
    }
};

}  // namespace

void PressureBeyond::begin(int blocks, const Vec3& gravityStep)
{
    fall_ = gravityStep.cwiseAbs().maxCoeff(&axis_);
    up_ = gravityStep[axis_] < 0.0 ? 1 : -1;
    tilt_ = gravityStep / fall_;
    resizeZero(impulse_, blocks);
    resizeZero(level_, blocks);
    resizeZero(handed_, blocks);
    hasAny_.assign(static_cast<std::size_t>(blocks) + 1, 0);
    isPushed_.assign(static_cast<std::size_t>(blocks) + 1, 0);
}

void PressureBeyond::bear(const CellRef& cell, double impulse, double level)
{
    impulse_.block(cell.block)[cell.cell] = impulse;
    level_.block(cell.block)[cell.cell] = level;
    std::atomic_ref(hasAny_[cell.block]).store(1, std::memory_order_relaxed);
}

void PressureBeyond::pushRow(const Faces& faces, int block, int axis, int j, int k)
{
    const RowsAlong down{RowAccess(faces.cut.grid, block), j, k, axis_, -up_};
    const RowAccess& rows = down.rows;
    const Pack zero = broadcast(0.0), own = rows.row(level_, 0, j, k), before = rows.below(level_, 0, axis, j, k);
    if (maskBits((own > 0.0) | (before > 0.0)) == 0) return;
    const Pack step = rows.row(impulse_, 0, j, k) - rows.below(impulse_, 0, axis, j, k);
    const BitAccess bits(faces.cut.grid, block);
    const auto& sums = faces.liquid.faces.sums;
    const int row = cellInBlock(0, j, k);
    const Pack room = loadPack(faces.cut.field.room(block, axis) + row), mass = down.here(sums, FaceFields::kMass + axis);
    PackMask counts = rowBits(faces.liquid.wet.block(block, axis), j, k) & (loadPack(faces.cut.field.open(block, axis) + row) > 0.0) & (room > 0.0);
    PackMask hands = counts & (own > 0.0) & (before > 0.0) & (down.here(faces.coefficient, axis) == 0.0) &
                     (down.further(faces.coefficient, axis) > 0.0) & (down.further(sums, FaceFields::kMass + axis) >= mass);
    if (faces.bare != nullptr) {
        counts &= rowBits(faces.bare->block(block, axis), j, k);
        hands &= counts & rowBits(up_ > 0 ? bits.below(*faces.bare, axis, axis_, k) : bits.above(*faces.bare, axis, axis_, k), j);
    }
    const Pack least = broadcast(-kSteepest), tilt = broadcast(tilt_[axis]);
    const Pack slope = tilt + maxPack(-maxPack(before - own + tilt, least), least), slid = -fall_ * slope;
    const Pack pushed = -step * room / maxPack(mass, kLeastFill * faces.liquid.fullMass * room);
    const Pack change = select(counts, select(hands, slid, pushed), zero);
    storePack(handed_.block(block, axis) + row, select(hands, mass * slid + room * step, zero));
    double* velocity = faces.liquid.faces.velocity.block(block, axis) + row;
    storePack(velocity, loadPack(velocity) + change);
    if (!faces.told) return;
    const Pack got = mass * change - (1.0 - room) * step;
    for (int l = 0; l < kLanes; ++l) faces.told->weightGrew(block, axis, row + l, got[l]);
}

void PressureBeyond::pushBlock(const Faces& faces, int block)
{
    isPushed_[block] = 1;
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; a != axis_ && k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) pushRow(faces, block, a, j, k);
}

void PressureBeyond::handDown(const Faces& faces, int block) const
{
    const RowAccess rows(faces.cut.grid, block);
    for (int a = 0; a < kAxes; ++a)
        for (int k = 0; a != axis_ && k < kBlockEdge; ++k)
            for (int j = 0; j < kBlockEdge; ++j) {
                const RowsAlong up{rows, j, k, axis_, up_};
                const Pack handed = up.further(handed_, a);
                const PackMask any = absPack(handed) > 0.0;
                if (maskBits(any) == 0) continue;
                double* velocity = faces.liquid.faces.velocity.block(block, a) + cellInBlock(0, j, k);
                const Pack mass = up.here(faces.liquid.faces.sums, FaceFields::kMass + a);
                storePack(velocity, loadPack(velocity) - select(any, handed / mass, broadcast(0.0)));
                if (!faces.told) continue;
                for (int l = 0; l < kLanes; ++l) faces.told->weightGrew(block, a, cellInBlock(l, j, k), -handed[l]);
            }
}

void PressureBeyond::push(const CutGrid& cut, const HeldBodies& bodies, LiquidGrid& liquid, const std::optional<LiquidOnSolids::Levelling>& told)
{
    const BlockGrid& grid = cut.grid;
    if (std::ranges::none_of(hasAny_, [](std::uint8_t any) { return any != 0; })) return;
    const Faces faces{cut, bodies.coefficient(), bodies.free().hasFabric ? &bodies.free().bare : nullptr, liquid, told};
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        if (hasAny(b) || std::ranges::any_of(kBlockBelow, [&](int below) { return hasAny(grid.neighbours(b)[below]); })) pushBlock(faces, b);
    });
    const int above = (up_ > 0 ? kBlockAbove : kBlockBelow)[axis_];
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        if (isPushed_[b] != 0 || isPushed_[grid.neighbours(b)[above]] != 0) handDown(faces, b);
    });
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        if (hasAny(b)) clearBlock(impulse_, b), clearBlock(level_, b);
        if (isPushed_[b] != 0) clearBlock(handed_, b);
    });
}

}  // namespace sim
