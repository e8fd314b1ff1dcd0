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

/// A cube of which a part may lie in solids.
struct Cube {
    Vec3 middle;
    double edge;   ///< [cm]
    double reach;  ///< as far seams are looked across [cm]
};

/// Middle of one of the eight cubes of half the edge in a cube, relative to its own middle [edges].
Vec3 middleOfHalf(int n) { return 0.25 * Vec3(n & 1 ? 1.0 : -1.0, n & 2 ? 1.0 : -1.0, n & 4 ? 1.0 : -1.0); }

/// What is open of a cube that a plane cuts, so far from its middle.
OpenCube cutByPlane(const Vec3& normal, double distance, double edge)
{
    const double share = shareOfCube(normal, distance / edge);
    return {share, 0.5 * share * (1.0 - share) * normal};  // the moment of a cut across an axis; of others nearly
}

/// Are the distances of a cube's corners those of one plane through a surface near its middle?
/// @param uneven  most that they may differ [edges]
bool isPlane(const Obstacles& obstacles, const NearSurface& surface, const Cube& cube, double uneven)
{
    for (int n = 0; n < 8; ++n) {
        const Vec3 corner = 2.0 * cube.edge * middleOfHalf(n);
        const double distance = distanceAcrossSeams(obstacles, cube.middle + corner, cube.reach);
        if (std::abs(distance - surface.distance - surface.normal.dot(corner)) >= uneven * cube.edge) return false;
    }
    return true;
}

/// Volume outside of solids in a cube.
/// @param halvings  of the edge, at most, where surfaces that meet at an edge or bend within the cube cut it
OpenCube openOf(const Obstacles& obstacles, const Cube& cube, int halvings)
{
    constexpr double kUneven = 0.05;  // [edges]
    const NearSurface surface = surfaceAcrossSeams(obstacles, cube.middle, cube.reach);
    if (std::abs(surface.distance) >= 0.5 * std::sqrt(3.0) * cube.edge) return {surface.distance > 0.0 ? 1.0 : 0.0, Vec3::Zero()};
    if (halvings == 0 || isPlane(obstacles, surface, cube, kUneven)) return cutByPlane(surface.normal, surface.distance, cube.edge);
    OpenCube open{0.0, Vec3::Zero()};
    for (int n = 0; n < 8; ++n) {
        const Vec3 at = middleOfHalf(n);
        const OpenCube half = openOf(obstacles, {cube.middle + cube.edge * at, 0.5 * cube.edge, cube.reach}, halvings - 1);
        open.share += 0.125 * half.share;
        open.moment += 0.125 * (half.share * at + 0.5 * half.moment);
    }
    return open;
}

/// The parts of a cell near a surface. Where that is one plane it is looked for once.
void findOpenParts(const Obstacles& obstacles, const Cube& cell, const Vec3i& first, OpenParts& open)
{
    constexpr double kUneven = 1.0e-6;  // [edges]
    constexpr int kMostHalvings = 2;
    const NearSurface surface = surfaceAcrossSeams(obstacles, cell.middle, cell.reach);
    const bool isOnePlane = isPlane(obstacles, surface, cell, kUneven);
    for (int n = 0; n < 8; ++n) {
        const double edge = 0.5 * cell.edge;
        const Vec3 middle = cell.edge * middleOfHalf(n);
        const OpenCube part = isOnePlane ? cutByPlane(surface.normal, surface.distance + surface.normal.dot(middle), edge)
                                         : openOf(obstacles, {cell.middle + middle, edge, cell.reach}, kMostHalvings);
        const int at = indexOf(first + Vec3i(n & 1, n >> 1 & 1, n >> 2));
        open.share[at] = part.share;
        for (int a = 0; a < kAxes; ++a) open.moment[a][at] = part.moment[a];
    }
}

/// Only the parts of cells that a surface cuts are looked at one by one.
void findOpen(const BlockGrid& grid, int block, const Obstacles& obstacles, OpenParts& open)
{
    static_assert(kParts == 2);
    const double reach = 0.5 * std::sqrt(3.0) * grid.dx;
    const Vec3 corner = grid.lowerCorner(block) - Vec3::Constant(kRim * grid.dx);
    for (OfParts& moment : open.moment) moment.fill(0.0);
    for (int k = 0; k < kEdge; k += kParts)
        for (int j = 0; j < kEdge; j += kParts)
            for (int i = 0; i < kEdge; i += kParts) {
                const Vec3i first(i, j, k);
                const Vec3 middle = corner + grid.dx * (first.cast<double>() / kParts + Vec3::Constant(0.5));
                const double distance = distanceAcrossSeams(obstacles, middle, grid.dx);
                for (int n = 0; n < 8; ++n) open.share[indexOf(first + Vec3i(n & 1, n >> 1 & 1, n >> 2))] = distance > 0.0 ? 1.0 : 0.0;
                if (std::abs(distance) < reach) findOpenParts(obstacles, {middle, grid.dx, grid.dx}, first, open);
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
