#include "sim/grid/closed_areas.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {

ClosedAreas::ClosedAreas(const BlockGrid& grid, int block, const Obstacles& obstacles)
    : grid_(grid), obstacles_(obstacles), corner_(grid.lowerCorner(block))
{
    const double half = 0.5 * kBlockEdge * grid.dx;
    for (int n = 0; n < obstacles.count() && count_ < kMost; ++n)
        if (obstacles.distance(corner_ + Vec3::Constant(half), n) < std::sqrt(3.0) * half) solid_[count_++] = n;
    for (int n = 0; n < count_ && areShared(); ++n) faces_[n].emplace(grid, block, obstacles, solid_[n]);
}

FaceOcclusion ClosedAreas::occlusion(int axis, const Vec3i& cell, double closed, int owner) const
{
    constexpr double kNothing = 1.0e-9, kAlike = 0.05;  // areas [-]; slopes of surfaces against the face
    struct Part {
        int solid;
        double area, slope, depth;
    };
    std::array<Part, kMost> parts;
    int count = 0;
    const Vec3 middle = corner_ + grid_.dx * (cell.cast<double>() + Vec3::Constant(0.5) - 0.5 * Vec3::Unit(axis));
    for (int n = 0; n < count_; ++n) {
        const double area = 1.0 - faces_[n]->open(axis, cell.x(), cell.y(), cell.z());
        if (area > kNothing)
            parts[count++] = {solid_[n], area, std::abs(obstacles_.normal(middle, solid_[n])[axis]),
                              std::abs(obstacles_.distance(middle, solid_[n]))};
    }
    if (count == 0) return {owner, FaceOcclusion::kNone, closed, 0.0};
    const auto comesFirst = [](const Part& a, const Part& b) { return std::abs(a.slope - b.slope) > kAlike ? a.slope < b.slope : a.depth < b.depth; };
    for (int n = 1; n < count; ++n)
        for (int m = n; m > 0 && comesFirst(parts[m], parts[m - 1]); --m) std::swap(parts[m], parts[m - 1]);
    FaceOcclusion occlusion{parts[0].solid, count > 1 ? parts[1].solid : owner, std::min(closed, parts[0].area), 0.0};
    occlusion.ofSecond = closed - occlusion.ofFirst;
    if (occlusion.second == occlusion.first) occlusion = {occlusion.first, FaceOcclusion::kNone, closed, 0.0};
    return occlusion;
}

}  // namespace sim
