#include "sim/grid/room.h"

#include "sim/grid/seams.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

using OfParts = OpenParts::OfParts;
constexpr int kRim = OpenParts::kRim, kParts = OpenParts::kParts, kEdge = OpenParts::kEdge;

int indexOf(const Vec3i& c) { return OpenParts::indexOf(c); }

/// Share of a unit cube on the side of a plane with unit normal n that n points to, the plane at distance d from its middle against n.
/// Source: Scardovelli and Zaleski 2000, Analytical relations connecting linear interfaces and volume fractions (their equation for cubes).
double shareOfCube(const Vec3& n, double d)
{
    constexpr double kFlat = 1.0e-6;  // a normal's part along an axis: less is none
    std::array<double, kAxes> m = {std::abs(n[0]), std::abs(n[1]), std::abs(n[2])};
    std::ranges::sort(m);
    const double sum = m[0] + m[1] + m[2], alpha = 0.5 * sum - std::abs(d);
    if (alpha <= 0.0) return d > 0.0 ? 1.0 : 0.0;
    const auto cube = [](double x) { return x > 0.0 ? x * x * x : 0.0; };
    const auto square = [](double x) { return x > 0.0 ? x * x : 0.0; };
    double less = 0.0;  // of the smaller side
    if (m[0] > kFlat) {
        less = cube(alpha);
        for (double edge : m) less -= cube(alpha - edge);
        less += cube(alpha - m[0] - m[1]) + cube(alpha - m[0] - m[2]) + cube(alpha - m[1] - m[2]);
        less /= 6.0 * m[0] * m[1] * m[2];
    } else if (m[1] > kFlat) {
        less = (square(alpha) - square(alpha - m[1]) - square(alpha - m[2])) / (2.0 * m[1] * m[2]);
    } else {
        less = alpha / m[2];
    }
    return d > 0.0 ? 1.0 - less : less;
}

/// What is open of a cube, and its first moments about the middle in edges of the cube.
struct OpenCube {
    double share;  ///< [-]
    Vec3 moment;   ///< [-]
};

/// Calls f(offset of its middle, in edges of the cube) for each of the eight halves of a cube.
template <class F>
void forEachHalf(F&& f)
{
    for (int n = 0; n < 8; ++n) f(0.25 * Vec3(n & 1 ? 1.0 : -1.0, n & 2 ? 1.0 : -1.0, n & 4 ? 1.0 : -1.0));
}

/// @param halvings  of the edge, at most, where surfaces that meet at an edge or bend within the cube cut it
OpenCube openOf(const Obstacles& obstacles, const Vec3& middle, double edge, double reach, int halvings)
{
    constexpr double kUneven = 0.05;  // of distances from those of a plane: less is one [edges]
    const auto [distance, normal] = surfaceAcrossSeams(obstacles, middle, reach);
    if (std::abs(distance) >= 0.5 * std::sqrt(3.0) * edge) return {distance > 0.0 ? 1.0 : 0.0, Vec3::Zero()};
    bool isPlane = true;
    if (halvings > 0)
        forEachHalf([&](const Vec3& at) {
            isPlane =
                isPlane && std::abs(distanceAcrossSeams(obstacles, middle + edge * at, reach) - distance - edge * normal.dot(at)) < kUneven * edge;
        });
    OpenCube cube{0.0, Vec3::Zero()};
    if (isPlane) {
        cube.share = shareOfCube(normal, distance / edge);
        cube.moment = 0.5 * cube.share * (1.0 - cube.share) * normal;  // of a cut across an axis; of others nearly
        return cube;
    }
    forEachHalf([&](const Vec3& at) {
        const OpenCube half = openOf(obstacles, middle + edge * at, 0.5 * edge, reach, halvings - 1);
        cube.share += 0.125 * half.share;
        cube.moment += 0.125 * (half.share * at + 0.5 * half.moment);
    });
    return cube;
}

/// Only the parts of cells that a surface cuts are looked at one by one.
void findOpen(const BlockGrid& grid, int block, const Obstacles& obstacles, OpenParts& open)
{
    constexpr int kMostHalvings = 2;
    const double part = grid.dx / kParts, reach = 0.5 * std::sqrt(3.0) * grid.dx;
    const Vec3 corner = grid.lowerCorner(block) - Vec3::Constant(kRim * grid.dx);
    for (OfParts& moment : open.moment) moment.fill(0.0);
    for (int k = 0; k < kEdge; k += kParts)
        for (int j = 0; j < kEdge; j += kParts)
            for (int i = 0; i < kEdge; i += kParts) {
                const double ofCell = distanceAcrossSeams(obstacles, corner + part * Vec3(i, j, k) + Vec3::Constant(0.5 * grid.dx), grid.dx);
                for (int n = 0; n < kParts * kParts * kParts; ++n) {
                    const Vec3i at(i + n % kParts, j + n / kParts % kParts, k + n / (kParts * kParts));
                    open.share[indexOf(at)] = ofCell > 0.0 ? 1.0 : 0.0;
                    if (std::abs(ofCell) >= reach) continue;
                    const OpenCube cube = openOf(obstacles, corner + part * (at.cast<double>() + Vec3::Constant(0.5)), part, grid.dx, kMostHalvings);
                    open.share[indexOf(at)] = cube.share;
                    for (int a = 0; a < kAxes; ++a) open.moment[a][indexOf(at)] = cube.moment[a];
                }
            }
}

/// The cells behind the wall get the mirror images of those in front.
/// @param plane  of the wall, in parts
void mirrorAt(const Obstacles::Wall& wall, int plane, OpenParts& open)
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
                open.share[indexOf(to)] = open.share[indexOf(from)];
                for (int a = 0; a < kAxes; ++a) open.moment[a][indexOf(to)] = (a == wall.axis ? -1.0 : 1.0) * open.moment[a][indexOf(from)];
            }
    }
}

/// Integrals along one axis of the B-splines around the lower faces, or around the middles, of a block's cells: both are where parts meet. They
/// stand where the first parts of each line were.
/// @param size    of what is there along the axes
/// @param moment  of the values along that axis; null: they are even within a part
void smooth(int axis, bool aroundFaces, const Vec3i& size, const OfParts* moment, OfParts& values)
{
    static_assert(kParts == 2);
    // Of the B-spline over parts, and its slope in their middles times their edge squared, from its own middle outwards.
    constexpr double kIntegral[3] = {16.0 / 48.0, 7.0 / 48.0, 1.0 / 48.0}, kSlope[3] = {-6.0 / 48.0, -9.0 / 48.0, -3.0 / 48.0};
    constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};
    const int u = (axis + 1) % kAxes, v = (axis + 2) % kAxes, step = kStep[axis];
    for (int p = 0; p < size[u]; ++p)
        for (int q = 0; q < size[v]; ++q) {
            const int first = p * kStep[u] + q * kStep[v];
            double sum[kBlockEdge] = {};
            for (int n = 0; n < kBlockEdge; ++n) {
                const int middle = first + (kParts * (kRim + n) + (aroundFaces ? 0 : 1)) * step;
                for (int m = 0; m < 3; ++m) {
                    const int above = middle + m * step, below = middle - (m + 1) * step;
                    sum[n] += kIntegral[m] * (values[above] + values[below]);
                    if (moment != nullptr) sum[n] += kSlope[m] * ((*moment)[above] - (*moment)[below]);
                }
            }
            for (int n = 0; n < kBlockEdge; ++n) values[first + n * step] = sum[n];
        }
}

}  // namespace

void roomOfFaces(const BlockGrid& grid, int block, const Obstacles& obstacles, bool mirrors, RoomScratch& scratch, double* room)
{
    OpenParts &open = scratch.open, &smoothed = scratch.smoothed;
    findOpen(grid, block, obstacles, open);
    if (mirrors)
        for (const Obstacles::Wall& wall : obstacles.planeWalls())
            if (const auto plane = planeOfFaces(grid, wall))
                mirrorAt(wall, kParts * (*plane - kBlockEdge * grid.coords(block)[wall.axis] + kRim), open);
    for (int a = 0; a < kAxes; ++a) {
        smoothed = open;
        Vec3i size = Vec3i::Constant(kEdge);
        for (int axis = 0; axis < kAxes; ++axis) {
            smooth(axis, axis == a, size, &smoothed.moment[axis], smoothed.share);
            for (int other = axis + 1; other < kAxes; ++other) smooth(axis, axis == a, size, nullptr, smoothed.moment[other]);
            size[axis] = kBlockEdge;
        }
        // Slopes within parts may lead beyond what there can be.
        for (int c = 0; c < kBlockCells; ++c) room[a * kBlockCells + c] = std::clamp(smoothed.share[indexOf({c & 7, c >> 3 & 7, c >> 6})], 0.0, 1.0);
    }
}

}  // namespace sim
