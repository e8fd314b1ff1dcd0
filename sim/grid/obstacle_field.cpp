#include "sim/grid/obstacle_field.h"

#include "sim/core/parallel.h"
#include "sim/grid/room.h"

#include <cmath>
#include <limits>

namespace sim {

namespace {

/// Nodes this near to a surface are on it, whatever the last bit of the distance says.
constexpr double kOnSurface = 1.0e-6;   ///< [cells]
constexpr double kAlmostClosed = 1.0e-3;  ///< open fractions below only hurt the conditioning (model-fluid 2.5)
constexpr double kAlmostOpen = 1.0 - 1.0e-6;

double crossing(double inside, double outside) { return inside / (inside - outside); }

}  // namespace

double ObstacleField::openFraction(double d00, double d10, double d11, double d01)
{
    const double d[4] = {d00, d10, d11, d01};
    int inside = 0, outside = 0;
    for (double v : d) {
        inside += v < 0.0;
        outside += v > 0.0;
    }
    if (outside == 0) return 0.0;
    if (inside == 0) return 1.0;
    const auto at = [&](int n) { return d[n & 3]; };
    if (inside == 1 || inside == 3) {
        int odd = 0;
        while ((at(odd) < 0.0) != (inside == 1)) ++odd;
        const double in = inside == 1 ? at(odd) : -at(odd), sign = inside == 1 ? 1.0 : -1.0;
        const double triangle = 0.5 * crossing(in, sign * at(odd + 1)) * crossing(in, sign * at(odd + 3));
        return inside == 1 ? 1.0 - triangle : triangle;
    }
    for (int n = 0; n < 4; ++n)
        if (at(n) < 0.0 && at(n + 1) < 0.0) return 1.0 - 0.5 * (crossing(at(n), at(n + 3)) + crossing(at(n + 1), at(n + 2)));
    // Two opposite corners inside: two corners cut off, of the solid or of the open part, as the mean decides.
    const int first = d[0] < 0.0 ? 0 : 1;
    const bool solidMiddle = d[0] + d[1] + d[2] + d[3] < 0.0;
    double cut = 0.0;
    for (int n = solidMiddle ? first + 1 : first; n < 4 + (solidMiddle ? first + 1 : first); n += 2)
        cut += 0.5 * crossing(at(n), at(n + 1)) * crossing(at(n), at(n + 3));
    return solidMiddle ? cut : 1.0 - cut;
}

/// Distance to the nearest solid on the 9³ nodes of a block [cm].
struct ObstacleField::Nodes {
    static constexpr int kEdge = kBlockEdge + 1;
    static constexpr int index(int i, int j, int k) { return (k * kEdge + j) * kEdge + i; }
    std::array<double, kEdge * kEdge * kEdge> distance;

    Nodes(const BlockGrid& grid, int block, const Obstacles& obstacles)
    {
        const Vec3 corner = grid.lowerCorner(block);
        for (int k = 0; k < kEdge; ++k)
            for (int j = 0; j < kEdge; ++j)
                for (int i = 0; i < kEdge; ++i) {
                    const double d = obstacles.distance(corner + grid.dx * Vec3(i, j, k));
                    distance[index(i, j, k)] = std::abs(d) < kOnSurface * grid.dx ? 0.0 : d;
                }
    }
    /// Open fraction of the face normal to `axis` at the lower side of cell (i, j, k), one of which may be 8.
    double open(int axis, int i, int j, int k) const
    {
        constexpr int kStep[3] = {index(1, 0, 0), index(0, 1, 0), index(0, 0, 1)};
        const double* n = distance.data() + index(i, j, k);
        const int u = kStep[(axis + 1) % 3], v = kStep[(axis + 2) % 3];
        const double fraction = openFraction(n[0], n[u], n[u + v], n[v]);
        return fraction < kAlmostClosed ? 0.0 : fraction > kAlmostOpen ? 1.0 : fraction;
    }
};

void ObstacleField::resizeSlots(int count)
{
    open_.resize(count);
    if (anyMoved_ || count == 1) wallVelocity_.resize(count);
    room_.resize(count);
    closed_.resize(count);
    blocked_.resize(count);
    centerDistance_.resize(count);
    touchedByMoving_.resize(count);
    if (slotCount_ == 0 && count > 0)
        for (int c = 0; c < kBlockCells; ++c) {
            centerDistance_.block(kOpenSlot)[c] = std::numeric_limits<double>::infinity();
            blocked_.block(kOpenSlot)[c / 64] = 0;
            for (int a = 0; a < kAxes; ++a) {
                open_.block(kOpenSlot, a)[c] = room_.block(kOpenSlot, a)[c] = 1.0;
                wallVelocity_.block(kOpenSlot, a)[c] = 0.0;
                closed_.block(kOpenSlot, a)[c / 64] = 0;
            }
        }
    slotCount_ = count;
}

int ObstacleField::takeSlot()
{
    if (freeSlots_.empty()) {
        freeSlots_.push_back(slotCount_);
        resizeSlots(slotCount_ + 1);
    }
    const int slot = freeSlots_.back();
    freeSlots_.pop_back();
    touchedByMoving_[slot] = 0;
    return slot;
}

bool ObstacleField::isNear(const BlockGrid& grid, double distance)
{
    // From its middle a block reaches half its diagonal.
    return distance < (0.5 * std::sqrt(3.0) * kBlockEdge + kExactDistance) * grid.dx;
}

void ObstacleField::update(const BlockGrid& grid, std::span<const int> previous, const Obstacles& obstacles, bool mirrors)
{
    isFolded_ = false;
    if (slotCount_ == 0) resizeSlots(1);
    oldSlot_.swap(slot_);
    slot_.assign(grid.count() + 1, kOpenSlot);
    nearSolid_.clear();
    if (obstacles.empty()) return;
    if (obstacles.anyMoving() && !anyMoved_) {
        anyMoved_ = true;
        wallVelocity_.resize(slotCount_);
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

    const Vec3 half = Vec3::Constant(0.5 * kBlockEdge * grid.dx);
    for (int b : toCompute_)
        if (isNear(grid, obstacles.distance(grid.lowerCorner(b) + half))) slot_[b] = takeSlot();
    for (int b = 0; b < grid.count(); ++b) {
        const bool reached = obstacles.anyMoving() && isNear(grid, obstacles.movingDistance(grid.lowerCorner(b) + half));
        const bool wasReached = slot_[b] != kOpenSlot && touchedByMoving_[slot_[b]] != 0;
        if (!reached && !wasReached) continue;
        if (slot_[b] == kOpenSlot) slot_[b] = takeSlot();
        touchedByMoving_[slot_[b]] = reached;
        toCompute_.push_back(b);
    }
    std::sort(toCompute_.begin(), toCompute_.end());
    toCompute_.erase(std::unique(toCompute_.begin(), toCompute_.end()), toCompute_.end());
    parallelFor(toCompute_.size(), [&](std::size_t n) {
        const int b = toCompute_[n];
        if (slot_[b] != kOpenSlot) computeSlot(grid, b, slot_[b], obstacles, mirrors);
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

void ObstacleField::computeSlot(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, bool mirrors)
{
    const Nodes nodes(grid, block, obstacles);
    computeFaces(grid, block, slot, obstacles, nodes);
    findBlocked(grid, block, slot, obstacles, nodes);
    roomOfFaces(grid, block, obstacles, mirrors, room_.block(slot));
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

void ObstacleField::computeFaces(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const Nodes& nodes)
{
    const Vec3 corner = grid.lowerCorner(block);
    for (int a = 0; a < kAxes; ++a) std::fill_n(closed_.block(slot, a), BlockBits<3>::kWords, 0);
    for (int k = 0; k < kBlockEdge; ++k)
        for (int j = 0; j < kBlockEdge; ++j)
            for (int i = 0; i < kBlockEdge; ++i) {
                const int cell = cellInBlock(i, j, k);
                const Vec3 center = corner + grid.dx * (Vec3(i, j, k) + Vec3::Constant(0.5));
                const double distance = obstacles.distance(center);
                centerDistance_.block(slot)[cell] = std::min(distance, kExactDistance * grid.dx);
                for (int a = 0; a < kAxes; ++a) {
                    double open = nodes.open(a, i, j, k);
                    if (open > 0.0 && isWallBetween(grid, obstacles, center, distance, a)) open = 0.0;
                    open_.block(slot, a)[cell] = open;
                    if (open == 0.0) closed_.set(slot, cell, a);
                    if (anyMoved_)
                        wallVelocity_.block(slot, a)[cell] =
                            touchedByMoving_[slot] ? obstacles.velocity(center - 0.5 * grid.dx * Vec3::Unit(a))[a] : 0.0;
                }
            }
}

void ObstacleField::findBlocked(const BlockGrid& grid, int block, int slot, const Obstacles& obstacles, const Nodes& nodes)
{
    const auto isClosed = [&](int a, const Vec3i& c) {
        if (nodes.open(a, c.x(), c.y(), c.z()) == 0.0) return true;
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
