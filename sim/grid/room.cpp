#include "sim/grid/room.h"

#include "sim/grid/seams.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr int kRim = 2;    ///< cells around a block that the B-splines of its faces reach
constexpr int kParts = 2;  ///< parts of a cell along an axis: the B-spline falls off within it
constexpr int kEdge = kParts * (kBlockEdge + 2 * kRim);

/// A value for each part of the cells of a block and its rim.
struct RimmedBlock {
    std::array<double, kEdge * kEdge * kEdge> v;

    static constexpr int index(int i, int j, int k) { return (k * kEdge + j) * kEdge + i; }
    double& at(const Vec3i& c) { return v[index(c.x(), c.y(), c.z())]; }
};

/// Open share of a cube, which is cut by the plane whose distance from its middle is the obstacle's.
double openShare(const Obstacles& obstacles, const Vec3& middle, double edge, double dx)
{
    return std::clamp(0.5 + distanceAcrossSeams(obstacles, middle, dx) / edge, 0.0, 1.0);
}

/// Only the parts of cells that a surface cuts are looked at one by one.
void openVolumes(const BlockGrid& grid, int block, const Obstacles& obstacles, RimmedBlock& volume)
{
    const double part = grid.dx / kParts, reach = 0.5 * std::sqrt(3.0) * grid.dx;
    const Vec3 corner = grid.lowerCorner(block) - Vec3::Constant(kRim * grid.dx);
    for (int k = 0; k < kEdge; k += kParts)
        for (int j = 0; j < kEdge; j += kParts)
            for (int i = 0; i < kEdge; i += kParts) {
                const Vec3 middle = corner + part * Vec3(i, j, k) + Vec3::Constant(0.5 * grid.dx);
                const double distance = distanceAcrossSeams(obstacles, middle, grid.dx);
                for (int n = 0; n < kParts * kParts * kParts; ++n) {
                    const Vec3i at(i + n % kParts, j + n / kParts % kParts, k + n / (kParts * kParts));
                    volume.at(at) = distance >= reach ? 1.0 : distance <= -reach ? 0.0 :
                                    openShare(obstacles, corner + part * (at.cast<double>() + Vec3::Constant(0.5)), part, grid.dx);
                }
            }
}

/// The cells behind the wall get the values of their mirror images in front.
/// @param plane  of the wall, in parts
void mirrorAt(const Obstacles::Wall& wall, int plane, RimmedBlock& volume)
{
    for (int layer = 0; layer < kParts * kRim; ++layer) {
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

/// Means along one axis over the B-splines around the lower faces, or around the middles, of a block's cells: both are where parts meet.
/// The means stand where the first parts of each line were.
/// @param size  of what is there along the axes
void smooth(int axis, bool aroundFaces, Vec3i& size, RimmedBlock& volume)
{
    static_assert(kParts == 2);
    constexpr double kIntegral[3] = {16.0 / 48.0, 7.0 / 48.0, 1.0 / 48.0};  // of the B-spline over parts, from its middle outwards
    constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};
    const int u = (axis + 1) % kAxes, v = (axis + 2) % kAxes, step = kStep[axis];
    for (int p = 0; p < size[u]; ++p)
        for (int q = 0; q < size[v]; ++q) {
            double* line = volume.v.data() + p * kStep[u] + q * kStep[v];
            double mean[kBlockEdge];
            for (int n = 0; n < kBlockEdge; ++n) {
                const double* middle = line + (kParts * (kRim + n) + (aroundFaces ? 0 : 1)) * step;
                mean[n] = 0.0;
                for (int m = 0; m < 3; ++m) mean[n] += kIntegral[m] * (middle[m * step] + middle[-(m + 1) * step]);
            }
            for (int n = 0; n < kBlockEdge; ++n) line[n * step] = mean[n];
        }
    size[axis] = kBlockEdge;
}

}  // namespace

void roomOfFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, bool mirrors, double* room)
{
    RimmedBlock volume;
    openVolumes(grid, block, obstacles, volume);
    if (mirrors)
        for (const Obstacles::Wall& wall : obstacles.planeWalls())
            if (const auto plane = planeOfFaces(grid, wall))
                mirrorAt(wall, kParts * (*plane - kBlockEdge * grid.coords(block)[wall.axis] + kRim), volume);
    for (int a = 0; a < kAxes; ++a) {
        RimmedBlock smoothed = volume;
        Vec3i size = Vec3i::Constant(kEdge);
        for (int axis = 0; axis < kAxes; ++axis) smooth(axis, axis == a, size, smoothed);
        for (int c = 0; c < kBlockCells; ++c)
            room[a * kBlockCells + c] = smoothed.at({c & 7, c >> 3 & 7, c >> 6});
    }
}

}  // namespace sim
