#include "sim/fabric/held.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

struct Accelerations {
    Vec3 own, all;
};

Accelerations randomState(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    return {std::pow(10.0, normal(random)) * vector(), std::pow(10.0, normal(random)) * vector()};
}

TEST(HeldShare, IsBetweenNothingAndAllOfTheDirectionOfTheForces)
{
    std::mt19937 random(1);
    for (int n = 0; n < 1000; ++n) {
        const auto [own, all] = randomState(random);
        const Vec3 held = heldShare(own, all);
        ASSERT_GE(held.minCoeff(), 0.0);
        ASSERT_LE(held.sum(), 1.0 + 1.0e-12) << "the trace of h d d^T is h";
    }
}

TEST(HeldShare, IsAllWhereNothingMovesAndNoneWhereForcesOnlyPush)
{
    std::mt19937 random(2);
    for (int n = 0; n < 1000; ++n) {
        const Vec3 own = randomState(random).own;
        const Vec3 along = own.normalized().cwiseAbs2();
        EXPECT_LT((heldShare(own, Vec3::Zero()) - along).norm(), 1.0e-12) << "taut: loads and forces cancel";
        EXPECT_EQ(heldShare(own, own), Vec3::Zero()) << "there is no other acceleration that they hold";
        EXPECT_EQ(heldShare(own, 3.0 * own), Vec3::Zero()) << "they go along with the load";
        EXPECT_LT((heldShare(own, -own) - 0.5 * along).norm(), 1.0e-12) << "half of what the load would do";
    }
}

TEST(HeldShare, KnowsNoUnitAndNoAxis)
{
    std::mt19937 random(3);
    for (int n = 0; n < 1000; ++n) {
        const auto [own, all] = randomState(random);
        const Vec3 held = heldShare(own, all);
        EXPECT_LT((heldShare(1.0e3 * own, 1.0e3 * all) - held).norm(), 1.0e-12);
        const auto shifted = [](const Vec3& v) { return Vec3(-v.y(), v.z(), -v.x()); };
        EXPECT_LT((heldShare(shifted(own), shifted(all)) - shifted(held).cwiseAbs()).norm(), 1.0e-12);
    }
}

}  // namespace
}  // namespace sim::test
