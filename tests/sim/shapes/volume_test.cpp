#include "sim/shapes/volume.h"

#include "sim/core/check.h"
#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

TEST(Volume, OfABoxIsItsProductWhateverTheCells)
{
    const Shape box = Shape::box({0.1, 0.2, 0.3}, {0.5, 0.7, 1.1});
    for (double cell : {0.05, 0.288, 1.0, 10.0}) EXPECT_NEAR(boundedVolume(box, cell) / (8 * 0.5 * 0.7 * 1.1), 1.0, 1e-12) << cell;
}

TEST(Volume, OfABallOfAFewCells)
{
    const double exact = 4.0 / 3.0 * kPi * std::pow(1.44, 3);
    EXPECT_NEAR(boundedVolume(Shape::ball({0.3, 0.1, 0.2}, 1.44), 0.288) / exact, 1.0, 5e-4);
    EXPECT_NEAR(boundedVolume(Shape::ball({0.3, 0.1, 0.2}, 1.44), 0.7) / exact, 1.0, 2e-3);
}

TEST(Volume, OfABoxThatStandsAskew)
{
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -1.0).normalized()));
    EXPECT_NEAR(boundedVolume(Shape::box(Vec3::Zero(), {1.0, 0.8, 1.2}).moved(turn), 0.2) / (8 * 0.96), 1.0, 2e-3);
}

TEST(Volume, OfTheDamBreakColumnIsLessThanItsBoxByItsRoundEdges)
{
    const Shape tank = Shape::roundedBox({-7.2, 14.4, 0.72}, {14.4, 14.4, 0.72}, 0.72);
    const Shape column = Shape::intersect({tank, Shape::box({13.92, 0.0, 0.72}, {15.84, 15.84, 1.44})});
    EXPECT_NEAR(boundedVolume(column, 0.288), 463.2, 0.05);
}

TEST(Volume, OfADifferenceIsTheDifference)
{
    const Shape shell = Shape::subtract({Shape::ball(Vec3::Zero(), 2.0), Shape::ball(Vec3::Zero(), 1.0)});
    EXPECT_NEAR(boundedVolume(shell, 0.2) / (4.0 / 3.0 * kPi * 7.0), 1.0, 1e-3);
    EXPECT_EQ(boundedVolume(Shape::subtract({Shape::ball(Vec3::Zero(), 1.0), Shape::ball(Vec3::Zero(), 2.0)}), 0.2), 0.0);
}

TEST(Volume, OfNothingIsZeroAndOfAllRefused)
{
    EXPECT_EQ(boundedVolume(Shape(), 0.1), 0.0);
    EXPECT_THROW(boundedVolume(Shape::ball(Vec3::Zero(), 1.0).inverted(), 0.1), InputError);
}

}  // namespace
}  // namespace sim
