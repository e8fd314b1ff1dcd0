#include "sim/fabric/friction_law.h"

#include "sim/fabric/contact/pair_turn.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace sim::test {
namespace {

using testing::Noise;

Vec3 inPlane(Noise& random, double size) { return size * Vec3(random(), random(), 0.0); }

/// In any state the force is the spring's as far as friction holds it, and Coulomb's beyond.
TEST(FrictionSpring, IsElasticUpToTheBound)
{
    Noise random(1);
    for (int i = 0; i < 1000; ++i) {
        const FrictionSpring spring{inPlane(random, 2.0), std::exp(3.0 * random()), std::abs(random())};
        const Vec3 slip = inPlane(random, 1.0), trial = spring.held + spring.stiffness * slip;
        const Friction friction = spring.at(slip);
        EXPECT_LE(friction.force.norm(), spring.bound * (1.0 + 1.0e-14));
        if (trial.norm() <= spring.bound) EXPECT_EQ(friction.force, trial);
        else EXPECT_LT((friction.force - spring.bound * trial.normalized()).norm(), 1.0e-14);
    }
}

/// Along any path, in steps of any length, it gives back no more than it may have stored: the square of the bound over twice its
/// stiffness, the least of those it had.
TEST(FrictionSpring, GivesBackNoMoreThanItStores)
{
    constexpr double kBound = 1.0;
    for (unsigned seed = 0; seed < 50; ++seed) {
        Noise random(seed);
        const bool varies = seed % 2 == 1;
        Vec3 held = Vec3::Zero();
        double taken = 0.0, softest = 1.0e300;
        for (int i = 0; i < 500; ++i) {
            const FrictionSpring spring{held, varies && i % 50 == 0 ? 4.0 : 16.0, kBound};
            softest = std::min(softest, spring.stiffness);
            const Vec3 slip = inPlane(random, 0.2);
            held = spring.at(slip).force;
            taken += held.dot(slip);  // backward Euler: the force at the end along the way
            EXPECT_GE(taken, -0.5 * kBound * kBound / softest) << seed;
        }
        EXPECT_GT(taken, 1.0) << seed;
    }
}

/// Pairs that turn like a rigid body about any axis turn what they hold along, and do not slide.
TEST(PairTurn, IsTheTurnOfARigidBody)
{
    Noise random(4);
    for (int i = 0; i < 500; ++i) {
        std::vector<Vec3> before(4);
        for (Vec3& x : before) x = random.vector();
        const Eigen::AngleAxisd turn(1.5 * random(), random.vector().normalized());
        std::vector<Vec3> now = before;
        const Vec3 shift = random.vector(), u = random.vector();
        for (Vec3& x : now) x = turn * x + shift;
        for (contact::PairKind kind : {contact::PairKind::EdgeEdge, contact::PairKind::VertexFace}) {
            const Vec3 first = kind == contact::PairKind::EdgeEdge ? before[1] - before[0] : before[2] - before[1];
            const Vec3 second = kind == contact::PairKind::EdgeEdge ? before[3] - before[2] : before[3] - before[1];
            if (std::abs(first.normalized().dot(second.normalized())) > 0.9) continue;
            EXPECT_LT((contact::PairTurn(kind, {0, 1, 2, 3}, before, now) * u - turn * u).norm(), 1.0e-10);
        }
    }
}

}  // namespace
}  // namespace sim::test
