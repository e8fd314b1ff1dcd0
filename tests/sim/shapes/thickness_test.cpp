#include "sim/shapes/thickness.h"

#include "sim/core/units.h"
#include "tests/sim/grid/random_solids.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

TEST(Thickness, IsThatOfThePlateHoweverItIsTurned)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 30; ++n) {
        const double thick = 0.02 * std::pow(10.0, 0.5 * (unit(random) + 1.0));
        const Eigen::Isometry3d turn(Eigen::AngleAxisd(kPi * unit(random), Vec3(unit(random), unit(random), unit(random)).normalized()));
        const Shape plate = Shape::box(Vec3(unit(random), unit(random), 0.0), {2.0, 0.5 * thick, 1.5}).moved(turn);
        EXPECT_NEAR(thicknessOf(plate, 0.25), thick, 0.01) << n;
    }
}

TEST(Thickness, OfAVesselIsThatOfItsWall)
{
    const Shape vessel = Shape::subtract({Shape::box(Vec3::Zero(), {1.1, 2.1, 1.1}), Shape::box(Vec3(0.0, 0.5, 0.0), {1.0, 2.5, 1.0})});
    EXPECT_NEAR(thicknessOf(vessel, 0.2), 0.1, 0.01);
    const Shape bowl =
        Shape::subtract({Shape::ball(Vec3::Zero(), 1.0), Shape::ball(Vec3::Zero(), 0.95), Shape::box({0.0, 1.0, 0.0}, {2.0, 1.0, 2.0})});
    EXPECT_NEAR(thicknessOf(bowl, 0.2), 0.05, 0.02);
}

TEST(Thickness, OfWhatIsNowhereThinIsItsSize)
{
    EXPECT_NEAR(thicknessOf(Shape::ball({1.0, 2.0, 3.0}, 1.5), 0.25), 3.0, 0.1);
    EXPECT_GT(thicknessOf(Shape::box(Vec3::Zero(), {1.0, 1.0, 1.0}), 0.25), 1.0);
    EXPECT_TRUE(std::isinf(thicknessOf(Shape::box(Vec3::Zero(), {1.0, 1.0, 1.0}).inverted(), 0.25)));
    EXPECT_TRUE(std::isinf(thicknessOf(Shape(), 0.25)));
}

TEST(Thickness, OfABallIsItsDiameterHoweverFineItIsLookedAt)
{
    for (double radius : {0.05, 0.4, 2.0, 30.0})
        for (double pitch : {0.02, 0.1, 0.25, 1.0}) {
            const double thick = thicknessOf(Shape::ball({1.0, -2.0, 0.5}, radius), pitch);
            EXPECT_NEAR(thick, 2.0 * radius, 0.05 * radius + 0.03 * pitch) << radius << " at " << pitch;
        }
}

/// A sheet of cells of its own pitch: what is thinner than the samples is as thick as they tell.
TEST(Thickness, OfAMeshIsThatOfTheBodyItIs)
{
    Chance chance(2);
    for (int n = 0; n < 12; ++n) {
        const double thick = chance.between(0.15, 0.6), pitch = 0.2;
        const Shape mesh = meshOfBox({1.0, 0.5 * thick, 1.3}, 0.5 * pitch).moved(chance.turn(2.0));
        EXPECT_NEAR(thicknessOf(mesh, pitch), thick, 0.25 * pitch) << n;
    }
}

TEST(Thickness, GrowsWithTheShapeAndThePitch)
{
    Chance chance(3);
    for (const Kind& kind : kSolidKinds) {
        if (kind.isMesh || kind.name == std::string("vessel")) continue;
        const Shape shape = kind.make(chance);
        const double thick = thicknessOf(shape, 0.1), moved = thicknessOf(shape.moved(Eigen::Isometry3d(Eigen::Translation3d(3.0, -4.0, 5.0))), 0.1);
        EXPECT_GT(thick, 0.0) << kind.name;
        EXPECT_NEAR(moved, thick, 1.1e-3) << kind.name;  // a stride of the search, a hundredth of the pitch
        EXPECT_LE(thick, shape.bounds().diagonal().norm()) << kind.name;
        // Turned, other places of it are looked at: near its edges and rims they tell of less.
        const double turned = thicknessOf(shape.moved(chance.turn(2.0)), 0.1);
        EXPECT_NEAR(turned, thick, 0.3 * thick + 0.02) << kind.name;
    }
}

}  // namespace
}  // namespace sim::test
