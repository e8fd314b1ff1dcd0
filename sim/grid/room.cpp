#include "sim/grid/room.h"

#include "sim/grid/seams.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr int kRim = 2;  ///< cells around a block that the B-splines of its faces reach
constexpr int kEdge = kBlockEdge + 2 * kRim;

/// A value for each cell of a block and its rim.
struct RimmedBlock {
    std::array<double, kEdge * kEdge * kEdge> v;

    static constexpr int index(int i, int j, int k) { return (k * kEdge + j) * kEdge + i; }
    double& at(const Vec3i& c) { return v[index(c.x(), c.y(), c.z())]; }
};

void openVolumes(const BlockGrid& grid, int block, const Obstacles& obstacles, RimmedBlock& volume)
{
    const Vec3 corner = grid.lowerCorner(block) + Vec3::Constant((0.5 - kRim) * grid.dx);
    for (int k = 0; k < kEdge; ++k)
        for (int j = 0; j < kEdge; ++j)
            for (int i = 0; i < kEdge; ++i)
                volume.at({i, j, k}) =
                    std::clamp(0.5 + distanceAcrossSeams(obstacles, corner + grid.dx * Vec3(i, j, k), grid.dx) / grid.dx, 0.0, 1.0);
}

/// The cells behind the wall get the values of their mirror images in front.
void mirrorAt(const Obstacles::Wall& wall, int plane, RimmedBlock& volume)
{
    for (int layer = 0; layer < kRim; ++layer) {
        const int front = wall.above ? plane - 1 - layer : plane + layer, behind = 2 * plane - 1 - front;
        if (std::min(front, behind) < 0 || std::max(front, behind) >= kEdge) continue;
        for (int v = 0; v < kEdge; ++v)
            for (int u = 0; u < kEdge; ++u) {
                Vec3i to, from;
                to[wall.axis] = behind;
                from[wall.axis] = front;
                to[(wall.axis + 1) % 3] = from[(wall.axis + 1) % 3] = u;
                to[(wall.axis + 2) % 3] = from[(wall.axis + 2) % 3] = v;
                volume.at(to) = volume.at(from);
            }
    }
}

/// Mean over the B-spline around the lower faces along an axis, or around the middles. What lies beyond the rim counts
/// as nothing; the block itself does not reach it.
void smooth(int axis, bool aroundFaces, RimmedBlock& volume)
{
    constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};
    const RimmedBlock from = volume;
    const int count = static_cast<int>(from.v.size());
    for (int c = 0; c < count; ++c) {
        const auto v = [&](int n) {
            const int cell = c + n * kStep[axis];
            return cell < 0 || cell >= count ? 0.0 : from.v[cell];
        };
        // Integrals of the B-spline over the cells that it overlaps.
        volume.v[c] = aroundFaces ? (v(-2) + v(1)) / 48.0 + (v(-1) + v(0)) * (23.0 / 48.0)
                                  : (v(-1) + v(1)) / 6.0 + v(0) * (2.0 / 3.0);
    }
}

}  // namespace

void roomOfFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, bool mirrors, double* room)
{
    RimmedBlock volume;
    openVolumes(grid, block, obstacles, volume);
    if (mirrors)
        for (const Obstacles::Wall& wall : obstacles.planeWalls())
            if (const auto plane = planeOfFaces(grid, wall))
                mirrorAt(wall, *plane - kBlockEdge * grid.coords(block)[wall.axis] + kRim, volume);
    for (int a = 0; a < kAxes; ++a) {
        RimmedBlock smoothed = volume;
        for (int axis = 0; axis < kAxes; ++axis) smooth(axis, axis == a, smoothed);
        for (int c = 0; c < kBlockCells; ++c)
            room[a * kBlockCells + c] = smoothed.at({(c & 7) + kRim, (c >> 3 & 7) + kRim, (c >> 6) + kRim});
    }
}

}  // namespace sim
