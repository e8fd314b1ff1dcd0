// Liquid at rest.
#include "tests/sim/liquid/tanks.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

TEST(Hydrostatics, ColumnRestsAndItsPressureIsItsDepth)
{
    for (double level : {3.05, 3.25, 3.499, 3.52, 3.75, 3.999, 7.3}) {
        GridScene scene = column(level);
        const SolveReport report = scene.project(kDt);
        EXPECT_TRUE(report.converged);
        EXPECT_LT(scene.largestError(kAtRest), 1.0e-10) << level;
        const double surface = scene.corner(Vec3i::Zero()).y() + level * scene.grid.dx;
        std::size_t cells = 0;
        scene.forEachCell([&](const Vec3i& c) {
            if (!scene.isInside(c)) return;
            ++cells;
            const double depth = surface - scene.middle(c).y();
            EXPECT_NEAR(scene.pressureAt(c), kGravity * depth, 1.0e-10 * kGravity * depth) << level << " at " << c.transpose();
        });
        EXPECT_EQ(cells, 30u * static_cast<std::size_t>(std::ceil(level - 0.5)));
    }
}

TEST(Hydrostatics, VerticalWallsMayStandAnywhere)
{
    GridScene scene({-3, -3, -3}, {12, 15, 10});
    const Vec3 low = scene.corner({0, 0, 0}) + scene.grid.dx * Vec3(0.37, 0.0, 0.81),
               high = scene.corner({7, 12, 5}) + scene.grid.dx * Vec3(0.6, 0.0, 0.13);
    scene.add(Shape::box(0.5 * (low + high), 0.5 * (high - low)).inverted());
    const double surface = low.y() + 5.3 * scene.grid.dx;
    scene.fill([&](const Vec3& x) { return x.y() - surface; });
    scene.setVelocities(kFalling);
    EXPECT_TRUE(scene.project(kDt).converged);
    EXPECT_LT(scene.largestError(kAtRest), 1.0e-10);
}

TEST(Hydrostatics, LiquidInATurnedTankRests)
{
    for (double angle : {0.4, 0.1, 1.2}) {
        GridScene scene({-3, -3, 4}, {24, 24, 14});
        scene.add(turnedTank(scene, angle, {7.1, 6.4, 3.7}));
        const double surface = scene.corner({10, 10, 10}).y() + 0.8 * scene.grid.dx;
        scene.fill([&](const Vec3& x) { return x.y() - surface; });
        scene.setVelocities(kFalling);
        EXPECT_TRUE(scene.project(kDt).converged);
        ASSERT_GT(scene.countLiquid(), 300u);
        EXPECT_LT(scene.largestError(kAtRest), 1.0e-8) << angle;
        scene.forEachCell([&](const Vec3i& c) {
            if (!scene.isInside(c) || scene.field.centerDistance(scene.at(c).block)[scene.at(c).cell] <= 0.0) return;
            EXPECT_NEAR(scene.pressureAt(c), kGravity * (surface - scene.middle(c).y()), 1.0e-8 * kGravity) << c.transpose();
        });
    }
}

}  // namespace
}  // namespace sim::test
