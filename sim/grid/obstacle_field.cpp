#include "sim/grid/obstacle_field.h"

#include "sim/core/parallel.h"
#include "sim/grid/room.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

/// Nodes this near to a surface are on it, whatever the last bit of the distance says.
constexpr double kOnSurface = 1.0e-6;   ///< [cells]
constexpr double kAlmostClosed = 1.0e-3;  ///< open fractions below only hurt the conditioning (model-fluid 2.5)
constexpr double kAlmostOpen = 1.0 - 1.0e-6;

}  // namespace

double ObstacleField::openFraction(const std::array<double, 4>& distance, const std::array<double, 4>& crossing)
{
    const auto at = [&](int n) { return distance[n & 3]; };
    // Share of the edge from corner n to the next one or the one before that ends at the surface.
    const auto toNext = [&](int n) { return crossing[n & 3]; };
    const auto toLast = [&](int n) { return 1.0 - crossing[(n + 3) & 3]; };
    int inside = 0, outside = 0;
    for (double v : distance) {
        inside += v < 0.0;
        outside += v > 0.0;
    }
    if (outside == 0) return 0.0;
    if (inside == 0) return 1.0;
    if (inside == 1 || inside == 3) {
        int odd = 0;
        while ((at(odd) < 0.0) != (inside == 1)) ++odd;
        const double triangle = 0.5 * toNext(odd) * toLast(odd);
        return inside == 1 ? 1.0 - triangle : triangle;
    }
    for (int n = 0; n < 4; ++n)
        if (at(n) < 0.0 && at(n + 1) < 0.0) return 1.0 - 0.5 * (toLast(n) + toNext(n + 1));
    // Two opposite corners inside: two corners cut off, of the solid or of the open part, as the mean decides.
    const int first = distance[0] < 0.0 ? 0 : 1;
    const bool solidMiddle = distance[0] + distance[1] + distance[2] + distance[3] < 0.0;
    const int corner = solidMiddle ? first + 1 : first;
    const double cut = 0.5 * (toNext(corner) * toLast(corner) + toNext(corner + 2) * toLast(corner + 2));
    return solidMiddle ? cut : 1.0 - cut;
}

/// Distance to the nearest solid on the 9³ nodes of a block [cm], and what it tells about the faces between them.
struct ObstacleField::Nodes {
    static constexpr int kEdge = kBlockEdge + 1;
    static constexpr int index(int i, int j, int k) { return (k * kEdge + j) * kEdge + i; }
    std::array<double, kEdge * kEdge * kEdge> distance;

    Nodes(const BlockGrid& grid, int block, const Obstacles& obstacles) : grid_(grid), obstacles_(obstacles), corner_(grid.lowerCorner(block))
    {
        for (int k = 0; k < kEdge; ++k)
            for (int j = 0; j < kEdge; ++j)
                for (int i = 0; i < kEdge; ++i) distance[index(i, j, k)] = distanceAt(corner_ + grid.dx * Vec3(i, j, k));
    }
    /// Open fraction of the face normal to `axis` at the lower side of cell (i, j, k), one of which may be 8.
    double open(int axis, int i, int j, int k) const
    {
        constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};
        const double* n = distance.data() + index(i, j, k);
        const int u = kStep[(axis + 1) % 3], v = kStep[(axis + 2) % 3];
        const std::array<double, 4> d = {n[0], n[u], n[u + v], n[v]};
        const auto [least, most] = std::minmax_element(d.begin(), d.end());
        if (*most < 0.0) return 0.0;
        if (*least > 0.0) return 1.0;
        const double fraction = openBetween(axis, Vec3(i, j, k), d);
        return fraction < kAlmostClosed ? 0.0 : fraction > kAlmostOpen ? 1.0 : fraction;
    }

 private:
    double distanceAt(const Vec3& x) const
    {
        const double d = obstacles_.distance(x);
        return std::abs(d) < kOnSurface * grid_.dx ? 0.0 : d;
    }
    /// A corner on a surface may be on the seam of two solids, with nothing but solid around it: the face is then seen a little within its rim.
    double openBetween(int axis, const Vec3& lower, std::array<double, 4> d) const
    {
        constexpr double kRim = 1.0e-5;  // [cells]
        const double rim = std::count(d.begin(), d.end(), 0.0) > 0 ? kRim : 0.0;
        const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3);
        const double near = rim, far = 1.0 - rim;
        const std::array<Vec3, 4> inCells = {near * u + near * v, far * u + near * v, far * u + far * v, near * u + far * v};
        std::array<Vec3, 4> x;
        std::array<double, 4> cut{};
        for (int n = 0; n < 4; ++n) {
            x[n] = corner_ + grid_.dx * (lower + inCells[n]);
            if (rim > 0.0) d[n] = distanceAt(x[n]);
        }
        for (int n = 0; n < 4; ++n)
            if ((d[n] < 0.0) != (d[(n + 1) & 3] < 0.0)) cut[n] = crossing(x[n], x[(n + 1) & 3], d[n], d[(n + 1) & 3]);
        return openFraction(d, cut);
    }
    /// Share of the way from one place to another, on two sides of the surface, where it is: as the distances say if it is plane, and bisected
    /// where they are those from two surfaces.
    double crossing(const Vec3& from, const Vec3& to, double first, double last) const
    {
        constexpr int kHalvings = 20;
        constexpr double kPlane = 1.0e-6;  // [cells]
        const double guess = first / (first - last);
        if (std::abs(obstacles_.distance(from + guess * (to - from))) < kPlane * grid_.dx) return guess;
        double low = 0.0, high = 1.0;
        for (int n = 0; n < kHalvings; ++n) {
            const double middle = 0.5 * (low + high);
            ((obstacles_.distance(from + middle * (to - from)) < 0.0) == (first < 0.0) ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    const BlockGrid& grid_;
    const Obstacles& obstacles_;
    Vec3 corner_;
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
