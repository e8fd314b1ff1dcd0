#include "sim/core/pack_math.h"

#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <limits>

namespace sim {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(PackMath, AnglesAreThoseOfTheLibraryInEveryQuadrant)
{
    testing::Noise noise(1);
    for (int n = 0; n < 20000; ++n) {
        Pack sine, cosine;
        for (int l = 0; l < kLanes; ++l) {
            const double length = std::pow(10.0, 20.0 * noise());
            sine[l] = length * (l < 4 ? noise() : std::pow(10.0, -10.0 + 10.0 * noise()));
            cosine[l] = length * noise();
        }
        const Pack angle = angleOf(sine, cosine);
        for (int l = 0; l < kLanes; ++l) {
            const double expected = std::atan2(sine[l], cosine[l]);
            ASSERT_NEAR(angle[l], expected, 1.5 * kEpsilon * std::abs(expected)) << sine[l] << ' ' << cosine[l];
        }
    }
}

TEST(PackMath, AnglesOfTheAxesAreExact)
{
    const Pack sine = {0.0, 0.0, 1.0, -1.0, 1.0, 1.0, -1.0, 0.0}, cosine = {1.0, -1.0, 0.0, 0.0, 1.0, -1.0, -1.0, 0.0};
    const Pack angle = angleOf(sine, cosine);
    for (int l = 0; l < kLanes; ++l) EXPECT_DOUBLE_EQ(angle[l], std::atan2(sine[l], cosine[l])) << l;
}

TEST(PackMath, DirectionsAreThoseOfTheLibraryAfterAnyNumberOfTurns)
{
    testing::Noise noise(2);
    for (const double largest : {1.0e-5, 1.0, 10.0, 1.0e4, 1.5e6, 1.0e12})
        for (int n = 0; n < 5000; ++n) {
            Pack angle;
            for (int l = 0; l < kLanes; ++l) angle[l] = largest * noise();
            const PackDirection d = directionOf(angle);
            for (int l = 0; l < kLanes; ++l) {
                ASSERT_NEAR(d.sine[l], std::sin(angle[l]), kEpsilon) << angle[l];
                ASSERT_NEAR(d.cosine[l], std::cos(angle[l]), kEpsilon) << angle[l];
            }
        }
}

}  // namespace
}  // namespace sim
