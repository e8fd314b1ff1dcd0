#include "sim/liquid/cells.h"

#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// Integral of the quadratic B-spline from −infinity to x [cells].
double splineUpTo(double x)
{
    if (x < -1.5) return 0.0;
    if (x < -0.5) return std::pow(x + 1.5, 3) / 6.0;
    if (x < 0.5) return 0.5 + 0.75 * x - x * x * x / 3.0;
    return x < 1.5 ? 1.0 - std::pow(1.5 - x, 3) / 6.0 : 1.0;
}

/// The masses that P2G gives of liquid below the plane y = level [cells from the scene's origin], all over where there
/// is room.
LiquidCells fillBelow(GridScene& scene, double level)
{
    scene.forEachFace([&](int a, const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const double height = c.y() + (a == 1 ? 0.0 : 0.5);
        scene.liquid.faces.sums.block(ref.block, FaceFields::kMass + a)[ref.cell] =
            scene.liquid.fullMass * scene.field.room(ref.block, a)[ref.cell] * splineUpTo(level - height);
    });
    return findLiquidCells(scene.cut(), scene.settings.full, scene.liquid);
}

double fillAt(const GridScene& scene, const Vec3i& c) { return scene.liquid.fill.block(scene.at(c).block)[scene.at(c).cell]; }

TEST(Cells, AmidLiquidAreFullAlsoBesideWalls)
{
    GridScene scene({-3, -3, -3}, {13, 16, 13});
    scene.liquid.fullMass = 0.9;
    scene.add(tankOfCells(scene, {0, 0, 0}, {10, 14, 9}));
    scene.add(Shape::ball(scene.corner({4, 3, 5}) + scene.grid.dx * Vec3(0.3, 0.2, 0.6), 2.3 * scene.grid.dx));
    fillBelow(scene, 12.0);
    std::size_t cells = 0;
    scene.forEachCell([&](const Vec3i& c) {
        if (c.y() > 9 || !scene.isInside(c)) return;
        EXPECT_NEAR(fillAt(scene, c), 1.0, 1.0e-12) << c.transpose();
        ++cells;
    });
    EXPECT_GT(cells, 850u);
    EXPECT_FALSE(scene.isInside({-1, 3, 3})) << "behind the wall";
    EXPECT_FALSE(scene.isInside({4, 3, 5})) << "in the ball";
}

TEST(Cells, ReachUpToHalfACellAboveTheSurface)
{
    for (double level : {4.02, 4.3, 4.48, 4.52, 4.75, 4.98}) {
        GridScene scene({0, 0, 0}, {8, 8, 8});
        fillBelow(scene, level);
        for (int j = 0; j < 7; ++j) {
            EXPECT_EQ(scene.isInside({3, j, 4}), j + 0.5 < level + 0.49) << level << ", row " << j;
            EXPECT_NEAR(fillAt(scene, {3, j, 4}), (4.0 * splineUpTo(level - j - 0.5) + splineUpTo(level - j) + splineUpTo(level - j - 1)) / 6.0,
                        1.0e-12);
        }
        // What the faces carry that are beside no liquid cell.
        int top = 0;
        while (scene.isInside({3, top, 4})) ++top;
        EXPECT_LT(splineUpTo(level - (top + 1)), 0.0215);
    }
}

TEST(Cells, OfAFullBoxAreAllThatAreNotBlocked)
{
    GridScene scene({0, 0, 0}, {16, 16, 16});
    scene.settings.full = true;
    scene.add(tankOfCells(scene, {2, 3, 4}, {14, 12, 11}));
    const LiquidCells cells = findLiquidCells(scene.cut(), scene.settings.full, scene.liquid);
    EXPECT_EQ(scene.countLiquid(), 12u * 9u * 7u);
    EXPECT_EQ(countLiquidCells(scene.grid, cells), 12u * 9u * 7u);
}

TEST(Cells, AtTheSurfaceAreThoseBesideAirNotThoseBesideWalls)
{
    GridScene scene({-3, -3, -3}, {13, 13, 13});
    scene.add(tankOfCells(scene, {0, 0, 0}, {10, 12, 9}));
    findSurface(scene.cut(), fillBelow(scene, 6.3), scene.liquid);
    scene.forEachCell([&](const Vec3i& c) {
        const CellRef ref = scene.at(c);
        const bool inTank = (c.array() >= 0).all() && c.x() < 10 && c.z() < 9;
        EXPECT_EQ(scene.liquid.surface.test(ref.block, ref.cell), inTank && c.y() == 6) << c.transpose();
        EXPECT_EQ(scene.liquid.deep.test(ref.block, ref.cell), inTank && c.y() < 5) << c.transpose();
    });
}

}  // namespace
}  // namespace sim::test
