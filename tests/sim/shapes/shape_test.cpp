#include "sim/shapes/shape.h"

#include "sim/core/check.h"
#include "sim/core/random.h"
#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sim {
namespace {

/// Points in a cube around 0.
std::vector<Vec3> somePoints(int count, double half, std::uint64_t seed = 7)
{
    const CounterRandom random(seed, 0);
    std::vector<Vec3> points(count);
    for (int p = 0; p < count; ++p)
        for (int a = 0; a < kAxes; ++a) points[p][a] = half * (2.0 * random.uniform(p, a) - 1.0);
    return points;
}

Eigen::Isometry3d someMotion() { return Eigen::Translation3d(0.3, -1.1, 0.7) * Eigen::AngleAxisd(0.8, Vec3(1.0, -2.0, 0.5).normalized()); }

struct Named {
    const char* name;
    Shape shape;
};

std::vector<Named> primitives()
{
    return {{"box", Shape::box({0.1, 0.2, -0.1}, {1.0, 0.5, 0.7})},
            {"rounded box", Shape::roundedBox({0.1, 0.2, -0.1}, {1.0, 0.5, 0.7}, 0.3)},
            {"ball", Shape::ball({0.2, -0.3, 0.1}, 1.2)},
            {"capsule", Shape::capsule({-0.5, 0.1, 0.2}, {0.8, 0.4, -0.3}, 0.4)},
            {"cylinder", Shape::cylinder({0.1, 0.0, -0.2}, Vec3(0.3, 1.0, 0.2).normalized(), 0.9, 0.5, 0.2)},
            {"moved box", Shape::roundedBox({0.1, 0.2, -0.1}, {1.0, 0.5, 0.7}, 0.1).moved(someMotion())}};
}

TEST(Shape, DistancesOfABoxAreThoseToItsFacesEdgesAndCorners)
{
    const Shape box = Shape::box({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0});
    EXPECT_DOUBLE_EQ(box.distance({1.0, 2.0, 3.0}), -1.0);
    EXPECT_DOUBLE_EQ(box.distance({2.5, 2.0, 3.0}), 0.5);
    EXPECT_DOUBLE_EQ(box.distance({5.0, 8.0, 3.0}), 5.0);
    EXPECT_DOUBLE_EQ(box.distance({-2.0, -3.0, -6.0}), 7.0);
    EXPECT_DOUBLE_EQ(box.distance({1.0, 3.75, 3.0}), -0.25);
}

TEST(Shape, RoundingAddsToABox)
{
    const Shape box = Shape::roundedBox(Vec3::Zero(), {1.0, 1.0, 1.0}, 0.5);
    EXPECT_DOUBLE_EQ(box.distance(Vec3::Zero()), -1.5);
    EXPECT_DOUBLE_EQ(box.distance({1.5, 0.0, 0.0}), 0.0);
    EXPECT_NEAR(box.distance({1.5, 1.5, 0.0}), std::sqrt(0.5) - 0.5, 1e-15);
    EXPECT_TRUE(box.bounds().isApprox(Eigen::AlignedBox3d(Vec3::Constant(-1.5), Vec3::Constant(1.5))));
}

TEST(Shape, RoundingKeepsTheSideOfACylinder)
{
    const Shape drum = Shape::cylinder(Vec3::Zero(), Vec3::UnitY(), 2.0, 1.0, 0.25);
    EXPECT_NEAR(drum.distance({3.0, 0.0, 0.0}), 1.0, 1e-15);
    EXPECT_NEAR(drum.distance({0.0, 2.0, 0.0}), 0.75, 1e-15);
    EXPECT_NEAR(drum.distance({0.0, 0.0, 0.0}), -1.25, 1e-15);
    EXPECT_NEAR(drum.distance({0.0, 2.0, 2.0}), std::hypot(0.25, 1.0) - 0.25, 1e-15);
    EXPECT_TRUE(drum.bounds().isApprox(Eigen::AlignedBox3d(Vec3(-2.0, -1.25, -2.0), Vec3(2.0, 1.25, 2.0))));
}

TEST(Shape, ACapsuleIsEverythingNearASegment)
{
    const Shape capsule = Shape::capsule({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.5);
    EXPECT_DOUBLE_EQ(capsule.distance({0.3, 2.0, 0.0}), 1.5);
    EXPECT_DOUBLE_EQ(capsule.distance({4.0, 4.0, 0.0}), 4.5);
    EXPECT_DOUBLE_EQ(capsule.distance({-3.0, 0.0, 0.0}), 1.5);
    EXPECT_NEAR(Shape::capsule(Vec3::Ones(), Vec3::Ones(), 0.5).distance(Vec3::Zero()), std::sqrt(3.0) - 0.5, 1e-15);
}

TEST(Shape, NormalsAreTheUnitSlopeOfTheDistance)
{
    constexpr double kStep = 1.0e-6;
    for (const Named& n : primitives()) {
        int kinks = 0;
        const auto points = somePoints(400, 2.0);
        for (const Vec3& x : points) {
            const Vec3 normal = n.shape.normal(x);
            EXPECT_NEAR(normal.norm(), 1.0, 1e-12) << n.name;
            Vec3 slope;
            for (int a = 0; a < kAxes; ++a) {
                const Vec3 step = kStep * Vec3::Unit(a);
                slope[a] = (n.shape.distance(x + step) - n.shape.distance(x - step)) / (2.0 * kStep);
            }
            if ((slope - normal).norm() > 1.0e-5) ++kinks;
        }
        EXPECT_LE(kinks, 1) << n.name;  // only on the medial surface, which random points hardly meet
    }
}

TEST(Shape, SteppingBackAlongTheNormalLandsOnTheSurface)
{
    for (const Named& n : primitives())
        for (const Vec3& x : somePoints(200, 2.5)) {
            const double d = n.shape.distance(x);
            if (d < 0.0) continue;
            EXPECT_NEAR(n.shape.distance(x - d * n.shape.normal(x)), 0.0, 1e-12) << n.name;
        }
}

TEST(Shape, NormalsAreUnitVectorsWhereTheDistanceHasNoSlope)
{
    EXPECT_NEAR(Shape::ball(Vec3::Ones(), 1.0).normal(Vec3::Ones()).norm(), 1.0, 1e-15);
    EXPECT_NEAR(Shape::box(Vec3::Ones(), Vec3::Ones()).normal(Vec3::Ones()).norm(), 1.0, 1e-15);
    EXPECT_NEAR(Shape::capsule(Vec3::Zero(), Vec3::Ones(), 1.0).normal(0.5 * Vec3::Ones()).norm(), 1.0, 1e-15);
    EXPECT_NEAR(Shape::cylinder(Vec3::Zero(), Vec3::UnitX(), 1.0, 4.0, 0.0).normal(Vec3::Zero()).norm(), 1.0, 1e-15);
    EXPECT_NEAR(Shape().normal(Vec3::Zero()).norm(), 1.0, 1e-15);
}

TEST(Shape, BoundsTouchTheSurfaceOnEverySide)
{
    for (const Named& n : primitives()) {
        const Eigen::AlignedBox3d box = n.shape.bounds();
        Eigen::AlignedBox3d met;
        for (const Vec3& x : somePoints(40000, 2.5)) {
            const Vec3 onSurface = x - n.shape.distance(x) * n.shape.normal(x);
            if (std::abs(n.shape.distance(onSurface)) < 1e-9) met.extend(onSurface);
        }
        EXPECT_LT((met.min() - box.min()).cwiseAbs().maxCoeff(), 0.02) << n.name;
        EXPECT_LT((met.max() - box.max()).cwiseAbs().maxCoeff(), 0.02) << n.name;
        EXPECT_TRUE(met.min().cwiseMin(box.min()).isApprox(box.min(), 1e-9)) << n.name;
        EXPECT_TRUE(met.max().cwiseMax(box.max()).isApprox(box.max(), 1e-9)) << n.name;
    }
}

TEST(Shape, MovesWithItsPoints)
{
    const Eigen::Isometry3d motion = someMotion(), again = motion * motion;
    std::vector<Named> all = primitives();
    all.push_back({"union", Shape::unite({all[0].shape, all[2].shape.inverted()})});
    all.push_back({"difference", Shape::subtract({all[0].shape, all[2].shape, all[3].shape})});
    for (const Named& n : all) {
        const Shape once = n.shape.moved(motion), twice = once.moved(motion);
        for (const Vec3& x : somePoints(100, 2.0)) {
            EXPECT_NEAR(once.distance(motion * x), n.shape.distance(x), 1e-12) << n.name;
            EXPECT_NEAR(twice.distance(again * x), n.shape.distance(x), 1e-12) << n.name;
            EXPECT_LT((once.normal(motion * x) - motion.linear() * n.shape.normal(x)).norm(), 1e-9) << n.name;
        }
    }
}

TEST(Shape, OperatorsFollowTheLogicOfSets)
{
    const Shape a = Shape::ball({0.4, 0.0, 0.0}, 1.0), b = Shape::box({-0.4, 0.2, 0.0}, {0.8, 0.6, 1.0});
    const Shape c = Shape::capsule({0.0, -1.0, 0.0}, {0.0, 1.0, 0.3}, 0.3);
    int inside = 0;
    for (const Vec3& x : somePoints(2000, 1.8)) {
        const bool inA = a.distance(x) < 0.0, inB = b.distance(x) < 0.0, inC = c.distance(x) < 0.0;
        EXPECT_EQ(Shape::unite({a, b, c}).distance(x) < 0.0, inA || inB || inC);
        EXPECT_EQ(Shape::intersect({a, b, c}).distance(x) < 0.0, inA && inB && inC);
        EXPECT_EQ(Shape::subtract({a, b, c}).distance(x) < 0.0, inA && !inB && !inC);
        EXPECT_EQ(a.inverted().distance(x) < 0.0, !inA);
        inside += inA && inB && inC;
    }
    EXPECT_GT(inside, 10);
}

TEST(Shape, NormalsOfOperatorsAreThoseOfTheChildThatDecides)
{
    const Shape a = Shape::ball({-2.0, 0.0, 0.0}, 1.0), b = Shape::ball({2.0, 0.0, 0.0}, 1.0);
    EXPECT_TRUE(Shape::unite({a, b}).normal({1.0, 3.0, 0.0}).isApprox(b.normal({1.0, 3.0, 0.0})));
    EXPECT_TRUE(Shape::intersect({a, b}).normal({1.0, 3.0, 0.0}).isApprox(a.normal({1.0, 3.0, 0.0})));
    EXPECT_TRUE(Shape::intersect({b, a}).normal({0.05, 3.0, 0.0}).isApprox(a.normal({0.05, 3.0, 0.0})));
    EXPECT_TRUE(Shape::unite({a, b}).normal({0.05, 3.0, 0.0}).isApprox(b.normal({0.05, 3.0, 0.0})));
    const Shape hollow = Shape::subtract({Shape::ball(Vec3::Zero(), 2.0), Shape::ball(Vec3::Zero(), 1.0)});
    EXPECT_TRUE(hollow.normal({1.1, 0.0, 0.0}).isApprox(Vec3(-1.0, 0.0, 0.0)));
    EXPECT_TRUE(hollow.normal({1.9, 0.0, 0.0}).isApprox(Vec3(1.0, 0.0, 0.0)));
}

TEST(Shape, EmptyShapesAreNowhereAndTheirOutsideIsEverywhere)
{
    const Shape nothing, ball = Shape::ball(Vec3::Zero(), 1.0);
    EXPECT_EQ(nothing.distance(Vec3::Zero()), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(nothing.bounds().isEmpty());
    EXPECT_EQ(nothing.inverted().distance(Vec3::Zero()), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(nothing.inverted().inverted().empty());
    EXPECT_TRUE(Shape::unite({}).empty());
    EXPECT_DOUBLE_EQ(Shape::unite({nothing, ball}).distance(Vec3::Zero()), -1.0);
    EXPECT_TRUE(Shape::intersect({nothing, ball}).empty());
    EXPECT_TRUE(Shape::subtract({ball, nothing.inverted()}).empty());
    EXPECT_DOUBLE_EQ(Shape::subtract({ball, nothing}).distance(Vec3::Zero()), -1.0);
    EXPECT_TRUE(nothing.moved(someMotion()).empty());
}

TEST(Shape, InvertedShapesAreUnboundedAndTurnBack)
{
    const Shape ball = Shape::ball(Vec3::Zero(), 1.0);
    EXPECT_TRUE(ball.inverted().isInverted());
    EXPECT_FALSE(ball.isInverted());
    EXPECT_FALSE(ball.inverted().inverted().isInverted());
    EXPECT_EQ(ball.inverted().bounds().max()[1], std::numeric_limits<double>::infinity());
    EXPECT_EQ(ball.inverted().moved(someMotion()).bounds().min()[2], -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(Shape::intersect({ball, Shape::box(Vec3::Zero(), Vec3::Constant(0.1)).inverted()}).bounds().isApprox(ball.bounds()));
    EXPECT_TRUE(Shape::intersect({ball, Shape::ball({5.0, 0.0, 0.0}, 1.0)}).bounds().isEmpty());
}

TEST(Shape, BoxesAlongTheAxesAreKnownAsSuch)
{
    const Shape box = Shape::box({1.0, 2.0, 3.0}, {0.5, 0.6, 0.7});
    ASSERT_TRUE(box.axisBox());
    EXPECT_FALSE(box.axisBox()->inside);
    EXPECT_TRUE(box.axisBox()->box.isApprox(box.bounds()));
    EXPECT_EQ(box.axisBox()->round, 0.0);
    ASSERT_TRUE(box.inverted().axisBox());
    EXPECT_TRUE(box.inverted().axisBox()->inside);
    const Eigen::Isometry3d shift(Eigen::Translation3d(1.0, 0.0, 0.0));
    ASSERT_TRUE(box.inverted().moved(shift).axisBox());
    EXPECT_DOUBLE_EQ(box.inverted().moved(shift).axisBox()->box.min()[0], 1.5);
    EXPECT_FALSE(box.moved(someMotion()).axisBox());
    const Shape rounded = Shape::roundedBox(Vec3::Zero(), Vec3::Ones(), 0.1);
    ASSERT_TRUE(rounded.axisBox());
    EXPECT_EQ(rounded.axisBox()->round, 0.1);
    EXPECT_TRUE(rounded.axisBox()->box.isApprox(rounded.bounds()));
    EXPECT_FALSE(Shape::ball(Vec3::Zero(), 1.0).axisBox());
    EXPECT_FALSE(Shape().axisBox());
}

TEST(Shape, RefusesSizesThatMakeNoSense)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(Shape::ball(Vec3::Zero(), -1.0), InputError);
    EXPECT_THROW(Shape::ball(Vec3::Constant(nan), 1.0), InputError);
    EXPECT_THROW(Shape::box(Vec3::Zero(), {1.0, -1.0, 1.0}), InputError);
    EXPECT_THROW(Shape::roundedBox(Vec3::Zero(), Vec3::Ones(), nan), InputError);
    EXPECT_THROW(Shape::cylinder(Vec3::Zero(), Vec3(1.0, 1.0, 0.0), 1.0, 1.0, 0.0), InputError);
    EXPECT_THROW(Shape::cylinder(Vec3::Zero(), Vec3::UnitX(), 1.0, 1.0, 2.0), InputError);
}

}  // namespace
}  // namespace sim
