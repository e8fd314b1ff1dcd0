#include "sim/grid/obstacle_field.h"

#include "sim/core/parallel.h"
#include "sim/grid/open_faces.h"
#include "sim/grid/room.h"
#include "sim/grid/seams.h"

#include <cmath>
#include <utility>

namespace sim {

void ObstacleField::resizeSlots(int count)
{
    open_.resize(count);
    if (anyMoved_ || count == 1) {
        wallVelocity_.resize(count);
        swept_.resize(count);
    }
    if (areSeveral_) {
        closer_.resize(count);
        ofSecond_.resize(count);
    }
    shared_.resize(count, 0);
    even_.resize(count, 1);
    room_.resize(count);
    closed_.resize(count);
    whole_.resize(count);
    blocked_.resize(count);
    centerDistance_.resize(count);
    owner_.resize(count);
    touchedByMoving_.resize(count);
    slotCount_ = count;
}

void ObstacleField::makeOpenSlot(double dx)
{
    resizeSlots(1);
    for (int c = 0; c < kBlockCells; ++c) {
        centerDistance_.block(kOpenSlot)[c] = kExactDistance * dx;
        owner_.block(kOpenSlot)[c] = 0;
        blocked_.block(kOpenSlot)[c / 64] = 0;
        for (int a = 0; a < kAxes; ++a) {
            open_.block(kOpenSlot, a)[c] = room_.block(kOpenSlot, a)[c] = 1.0;
            wallVelocity_.block(kOpenSlot, a)[c] = swept_.block(kOpenSlot, a)[c] = 0.0;
            closed_.block(kOpenSlot, a)[c / 64] = 0;
            whole_.block(kOpenSlot, a)[c / 64] = ~std::uint64_t{0};
        }
    }
}

int ObstacleField::takeSlot()
{
    if (freeSlots_.empty()) {
        freeSlots_.push_back(slotCount_);
        resizeSlots(slotCount_ + 1);
    }
    const int slot = freeSlots_.back();
    freeSlots_.pop_back();
    touchedByMoving_[slot] = shared_[slot] = 0;
    return slot;
}

bool ObstacleField::isNear(const BlockGrid& grid, int block, const Obstacles& obstacles, Obstacles::Which which)
{
    const double half = 0.5 * kBlockEdge * grid.dx;
    return obstacles.reach(grid.lowerCorner(block) + Vec3::Constant(half), half, kExactDistance * grid.dx, which);
}

void ObstacleField::update(const BlockGrid& grid, std::span<const int> previous, const Obstacles& obstacles, bool mirrors)
{
    isFolded_ = false;
    mirrors_ = mirrors;
    const bool wereSeveral = std::exchange(areSeveral_, obstacles.count() > 1);
    if (slotCount_ == 0) makeOpenSlot(grid.dx);
    else if (areSeveral_ && !wereSeveral) resizeSlots(slotCount_);
    oldSlot_.swap(slot_);
    slot_.assign(grid.count() + 1, kOpenSlot);
    nearSolid_.clear();
    if (obstacles.empty()) return;
    if (obstacles.anyDisplaced() && !anyMoved_) {
        anyMoved_ = true;
        // Slots that were computed while everything rested are not computed again before something that moves reaches them.
        for (BlockArray<double, 3>* velocity : {&wallVelocity_, &swept_}) {
            velocity->resize(slotCount_);
            std::fill_n(velocity->block(0), static_cast<std::size_t>(slotCount_) * BlockArray<double, 3>::kStride, 0.0);
        }
    }

    toCompute_.clear();
    const int oldBlocks = static_cast<int>(oldSlot_.size()) - 1;
    for (int b = 0; b < grid.count(); ++b) {
        const int old = previous[b];
        if (old == BlockGrid::kNone || old >= oldBlocks) {
            toCompute_.push_back(b);
            continue;
        }
        slot_[b] = oldSlot_[old];
        oldSlot_[old] = kOpenSlot;  // taken over
    }
    for (int old = 0; old < oldBlocks; ++old)
        if (oldSlot_[old] != kOpenSlot) freeSlots_.push_back(oldSlot_[old]);

    for (int b : toCompute_)
        if (isNear(grid, b, obstacles, Obstacles::Which::All)) slot_[b] = takeSlot();
    for (int b = 0; b < grid.count(); ++b) {
        const bool reached = obstacles.anyDisplaced() && isNear(grid, b, obstacles, Obstacles::Which::Displaced);
        const bool wasReached = slot_[b] != kOpenSlot && touchedByMoving_[slot_[b]] != 0;
        if (!reached && !wasReached) continue;
        if (slot_[b] == kOpenSlot) slot_[b] = takeSlot();
        touchedByMoving_[slot_[b]] = reached;
        toCompute_.push_back(b);
    }
    std::sort(toCompute_.begin(), toCompute_.end());
    toCompute_.erase(std::unique(toCompute_.begin(), toCompute_.end()), toCompute_.end());
    roomScratch_.resize(workerCount());
    parallelForWorkers(toCompute_.size(), 1, [&](std::size_t n, int worker) {
        const int b = toCompute_[n];
        if (slot_[b] != kOpenSlot) computeSlot(grid, b, slot_[b], obstacles, mirrors, roomScratch_[worker]);
    });
    for (int b = 0; b < grid.count(); ++b)
        if (nearSolid(b)) nearSolid_.push_back(b);
}

void ObstacleField::foldRoom(bool isFolded)
{
    isFolded_ = isFolded;
    if (!isFolded) return;
    folded_.resize(slotCount_);
    parallelFor(slotCount_, 8, [&](std::size_t slot) {
        std::copy_n(room_.block(static_cast<int>(slot)), BlockArray<double, 3>::kStride, folded_.block(static_cast<int>(slot)));
    });
}

void ObstacleField::computeSlot(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, bool mirrors, RoomScratch& scratch)
{
    const OpenFaces faces(grid, block, obstacles);
    computeFaces(grid, block, slot, obstacles, faces);
    if (areSeveral_) computeClosed(grid, block, slot, obstacles);
    findBlocked(grid, block, slot, obstacles, faces);
    roomOfFaces(grid, block, obstacles, mirrors, scratch, room_.block(slot));
    even_[slot] = isSlotEven(slot);
}

bool ObstacleField::isSlotEven(int slot) const
{
    constexpr double kRounding = 1.0e-12;  // of parts of a face [-]
    const double *open = open_.block(slot), *room = room_.block(slot);
    for (std::size_t n = 0; n < BlockArray<double, 3>::kStride; ++n)
        if (open[n] > 0.0 && std::abs(open[n] - room[n]) > kRounding) return false;
    return true;
}

/// Is there a wall between the middles of a cell and the one below, both of which are outside of it? It is thinner than a cell, and may be
/// between the nodes that tell how open the face is.
bool ObstacleField::isWallBetween(const BlockGrid& grid, const Obstacles& obstacles, const Vec3& center, double distance, int axis)
{
    constexpr double kResolution = 0.02;  // [cells]
    if (distance <= 0.0 || distance >= grid.dx) return false;
    const Vec3 below = center - grid.dx * Vec3::Unit(axis);
    const double other = obstacles.distance(below);
    return other > 0.0 && distance + other <= grid.dx && obstacles.firstContactAtEnd(center, below, kResolution * grid.dx).has_value();
}

void ObstacleField::computeFaces(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const OpenFaces& faces)
{
    const Vec3 corner = grid.lowerCorner(block);
    for (BlockBits<3>* bits : {&closed_, &whole_}) std::fill_n(bits->block(slot), kAxes * BlockBits<3>::kWords, 0);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j)
            for (int i = 0; i < kBlockEdge; ++i) {
                const int cell = cellInBlock(i, j, k);
                const Vec3 center = corner + grid.dx * (Vec3(i, j, k) + Vec3::Constant(0.5));
                const double distance = distanceAcrossSeams(obstacles, center, kExactDistance * grid.dx);
                centerDistance_.block(slot)[cell] = std::min(distance, kExactDistance * grid.dx);
                owner_.block(slot)[cell] = static_cast<std::uint16_t>(distance < kExactDistance * grid.dx ? obstacles.nearest(center) : 0);
                for (int a = 0; a < kAxes; ++a) {
                    double open = faces.open(a, i, j, k);
                    if (open > 0.0 && isWallBetween(grid, obstacles, center, distance, a)) open = 0.0;
                    open_.block(slot, a)[cell] = open;
                    if (open == 0.0) closed_.set(slot, cell, a);
                    if (open >= 1.0) whole_.set(slot, cell, a);
                    if (!anyMoved_) continue;
                    const double wall = touchedByMoving_[slot] ? obstacles.velocity(center - 0.5 * grid.dx * Vec3::Unit(a))[a] : 0.0;
                    wallVelocity_.block(slot, a)[cell] = wall;
                    swept_.block(slot, a)[cell] = (1.0 - open) * wall;
                }
            }
}

/// What several solids close is divided among them.
void ObstacleField::computeClosed(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles)
{
    const ClosedAreas areas(grid, block, obstacles);
    shared_[slot] = areas.areShared();
    if (!areas.areShared()) return;
    const Vec3 corner = grid.lowerCorner(block);
    for (int c = 0; c < kBlockCells; ++c) {
        const Vec3i cell(c & 7, c >> 3 & 7, c >> 6);
        for (int a = 0; a < kAxes; ++a) {
            ofSecond_.block(slot, a)[c] = 0.0;
            const double closed = 1.0 - open_.block(slot, a)[c];
            closer_.block(slot, a)[c] = owner_.block(slot)[c];
            if (closed == 0.0) continue;
            const Vec3 middle = corner + grid.dx * (cell.cast<double>() + Vec3::Constant(0.5) - 0.5 * Vec3::Unit(a));
            const FaceOcclusion by = areas.occlusion(a, cell, closed, obstacles.nearest(middle));
            closer_.block(slot, a)[c] = static_cast<std::uint16_t>(by.first);
            if (by.second != FaceOcclusion::kNone) closer_.block(slot, kAxes + a)[c] = static_cast<std::uint16_t>(by.second);
            ofSecond_.block(slot, a)[c] = by.ofSecond;
            if (!anyMoved_ || !touchedByMoving_[slot]) continue;
            double& swept = swept_.block(slot, a)[c];
            swept = by.ofFirst * obstacles.velocity(middle, by.first)[a];
            if (by.ofSecond > 0.0) swept += by.ofSecond * obstacles.velocity(middle, by.second)[a];
        }
    }
}

FaceOcclusion ObstacleField::occlusion(int block, int axis, int face) const
{
    const int slot = slot_[block];
    const double ofSecond = ofSecond_.block(slot, axis)[face], ofFirst = 1.0 - open_.block(slot, axis)[face] - ofSecond;
    const int second = ofSecond > 0.0 ? closer_.block(slot, kAxes + axis)[face] : FaceOcclusion::kNone;
    return {closer_.block(slot, axis)[face], second, ofFirst, ofSecond};
}

void ObstacleField::findBlocked(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const OpenFaces& faces)
{
    const auto isClosed = [&](int a, const Vec3i& c) {
        if (c[a] < kBlockEdge) return closed_.test(slot, cellInBlock(c.x(), c.y(), c.z()), a);
        if (faces.open(a, c.x(), c.y(), c.z()) == 0.0) return true;
        const Vec3 center = grid.lowerCorner(block) + grid.dx * (c.cast<double>() + Vec3::Constant(0.5));
        return isWallBetween(grid, obstacles, center, obstacles.distance(center), a);
    };
    std::fill_n(blocked_.block(slot), BlockBits<>::kWords, 0);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j)
            for (int i = 0; i < kBlockEdge; ++i) {
                bool blocked = true;
                for (int a = 0; a < kAxes && blocked; ++a)
                    blocked = isClosed(a, {i, j, k}) && isClosed(a, {i + (a == 0), j + (a == 1), k + (a == 2)});
                if (blocked) blocked_.set(slot, cellInBlock(i, j, k));
            }
}

}  // namespace sim
