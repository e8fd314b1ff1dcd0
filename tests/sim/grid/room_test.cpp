#include "sim/grid/room.h"

#include "sim/core/random.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace sim::test {
namespace {

std::vector<double> room(const GridScene& scene, int block, bool mirrors)
{
    std::vector<double> result(3 * kBlockCells);
    const auto scratch = std::make_unique<RoomScratch>();
    roomOfFaces(scene.grid, block, scene.obstacles, mirrors, *scratch, result.data());
    return result;
}

TEST(Room, BesideAPlaneWallIsTheIntegralOfTheSpline)
{
    GridScene scene({0, 0, 0}, {8, 8, 8});
    scene.add(tankOfCells(scene, {3, -50, -50}, {60, 60, 60}));
    const std::vector<double> values = room(scene, 0, false), mirrored = room(scene, 0, true);
    // Faces normal to x stand in the wall's plane (half of their spline is in front), one cell in front of it, …
    const double normal[8] = {0.0, 0.0, 1.0 / 48.0, 0.5, 47.0 / 48.0, 1.0, 1.0, 1.0};
    const double tangential[8] = {0.0, 0.0, 1.0 / 6.0, 5.0 / 6.0, 1.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 8; ++i) {
        const int c = cellInBlock(i, 4, 5);
        EXPECT_NEAR(values[c], normal[i], 1.0e-14) << i;
        for (int a = 1; a < kAxes; ++a) EXPECT_NEAR(values[a * kBlockCells + c], tangential[i], 1.0e-14) << i;
        if (i < 3) continue;
        for (int a = 0; a < kAxes; ++a) EXPECT_NEAR(mirrored[a * kBlockCells + c], 1.0, 1.0e-14) << "the image counts, " << i;
    }
}

/// However thin and bent what is open may be: a share of a volume.
TEST(Room, IsAShare)
{
    const CounterRandom random(3, 1);
    std::uint64_t next = 0;
    const auto draw = [&](double low, double high) { return low + (high - low) * random.uniform(next++); };
    for (int n = 0; n < 60; ++n) {
        GridScene scene({0, 0, 0}, {8, 8, 8});
        const double dx = scene.grid.dx, radius = draw(0.5, 3.0) * dx;
        const Vec3 at = scene.corner({4, 4, 4}) + dx * Vec3(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0));
        const Vec3 hole = at + draw(0.0, 0.8) * dx * Vec3(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0));
        scene.add(Shape::subtract({Shape::ball(at, radius), Shape::ball(hole, radius)}).inverted());
        for (const double value : room(scene, 0, false)) {
            ASSERT_GE(value, 0.0) << "crescent " << n;
            ASSERT_LE(value, 1.0) << "crescent " << n;
        }
    }
}

/// Integral of the quadratic B-spline up to z cells from its middle.
double splineUpTo(double z)
{
    if (z < 0.0) return 1.0 - splineUpTo(-z);
    if (z > 1.5) return 1.0;
    return z < 0.5 ? 0.5 + 0.75 * z - z * z * z / 3.0 : 1.0 - std::pow(1.5 - z, 3) / 6.0;
}

/// Walls need not be where faces are. What is open of a cut part is known by volume and first moments: without the moments rooms were ten times as
/// far off.
TEST(Room, BesideAPlaneWallAnywhereIsNearlyTheIntegralOfTheSpline)
{
    for (double shift = 0.05; shift < 1.0; shift += 0.1) {
        GridScene scene({0, 0, 0}, {8, 8, 8});
        scene.add(Shape::box(scene.corner({-50, 0, 0}) + Vec3((3.0 + shift) * scene.grid.dx, 0.0, 0.0), Vec3::Constant(50.0 * scene.grid.dx)));
        const std::vector<double> values = room(scene, 0, false);
        for (int i = 0; i < 8; ++i)
            for (int a = 0; a < kAxes; ++a)
                EXPECT_NEAR(values[a * kBlockCells + cellInBlock(i, 4, 5)], splineUpTo(i + (a == 0 ? 0.0 : 0.5) - 3.0 - shift), 0.0025)
                    << "shift " << shift << ", axis " << a << ", face " << i;
    }
}

TEST(Room, AddsUpToTheOpenVolume)
{
    GridScene scene({0, 0, 0}, {24, 24, 24});
    scene.add(Shape::ball(scene.corner({12, 12, 12}) + scene.grid.dx * Vec3(0.3, -0.2, 0.1), 4.3 * scene.grid.dx));
    const double ball = 4.0 / 3.0 * 3.14159265358979 * std::pow(4.3, 3);
    for (int a = 0; a < kAxes; ++a) {
        double closed = 0.0;
        for (int b = 0; b < scene.grid.count(); ++b)
            for (int c = 0; c < kBlockCells; ++c) closed += 1.0 - scene.field.room(b, a)[c];
        EXPECT_NEAR(closed, ball, 0.004 * ball);  // which parts that planes cut make .34 % too large
    }
}

/// Where walls meet at an edge or in a corner the room is the product along the axes. With parts cut by one plane each it was up to .031 off.
TEST(Room, InACornerIsNearlyTheProductOfTheIntegrals)
{
    const CounterRandom random(5, 1);
    for (std::uint64_t n = 0; n < 20; ++n) {
        GridScene scene({0, 0, 0}, {8, 8, 8});
        Vec3 at;  // of the corner of what is open, in cells
        for (int a = 0; a < kAxes; ++a) at[a] = 4.0 + random.uniform(3 * n + a);
        const Vec3 corner = scene.corner({0, 0, 0}) + scene.grid.dx * at;
        scene.add(Shape::box(corner - Vec3::Constant(50.0 * scene.grid.dx), Vec3::Constant(50.0 * scene.grid.dx)).inverted());
        const std::vector<double> values = room(scene, 0, false);
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                double expected = 1.0;
                for (int axis = 0; axis < kAxes; ++axis)
                    expected *= splineUpTo(at[axis] - (axis == 0 ? c & 7 : axis == 1 ? c >> 3 & 7 : c >> 6) - (axis == a ? 0.0 : 0.5));
                EXPECT_NEAR(values[a * kBlockCells + c], expected, 0.0125) << at.transpose() << ", axis " << a << ", face " << c;
            }
    }
}

TEST(Room, CellsWithoutAnOpenFaceAreBlocked)
{
    GridScene scene({0, 0, 0}, {16, 16, 16});
    scene.add(tankOfCells(scene, {2, 3, 4}, {14, 12, 11}));
    scene.add(Shape::ball(scene.corner({8, 8, 8}), 2.3 * scene.grid.dx));
    std::size_t blocked = 0;
    scene.forEachCell([&](const Vec3i& c) {
        if ((c.array() == 15).any()) return;  // whose upper faces are in no block
        bool open = false;
        for (int a = 0; a < kAxes; ++a) open = open || scene.open(a, c) > 0.0 || scene.open(a, c + Vec3i::Unit(a)) > 0.0;
        const CellRef ref = scene.at(c);
        const bool isBlocked = scene.field.blocked(ref.block)[ref.cell >> 6] >> (ref.cell & 63) & 1;
        EXPECT_EQ(isBlocked, !open) << c.transpose();
        blocked += isBlocked;
    });
    EXPECT_GT(blocked, 1000u);
}

}  // namespace
}  // namespace sim::test
