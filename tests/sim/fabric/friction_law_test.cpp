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

/// A mass that slides across a spring of friction, in any direction: iterations until its slip errs by less than a hundredth.
int iterationsOfSlide(const FrictionSpring& spring, const Vec3& free, double give, double ofChord)
{
    const auto next = [&](const Vec3& slip, double part) -> Vec3 {
        const Friction f = spring.at(slip, part);
        return (free - give * (f.force - f.along * slip)) / (1.0 + give * f.along);
    };
    Vec3 rest = free;
    for (int i = 0; i < 20000; ++i) rest = next(rest, 1.0);
    Vec3 slip = free;
    int count = 0;
    for (; count < 200 && (slip - rest).norm() > 1.0e-2 * rest.norm(); ++count) slip = next(slip, ofChord);
    return count;
}

/// Held back much and with a force at its start across its way, too.
TEST(FrictionSpring, HalfOfTheChordFindsTheSlideInFewerIterations)
{
    Noise random(5);
    int sum = 0, whole = 0, most = 0, mostOfWhole = 0;
    for (int i = 0; i < 300; ++i) {
        const double give = std::pow(10.0, 0.7 * random());
        const FrictionSpring spring{inPlane(random, 0.7), 4.0, 1.0};
        const Vec3 direction = inPlane(random, 1.0).normalized(), free = (give * 1.0 + 0.3 + std::abs(random())) * direction;
        const int half = iterationsOfSlide(spring, free, give, 0.5), full = iterationsOfSlide(spring, free, give, 1.0);
        sum += half, whole += full;
        most = std::max(most, half), mostOfWhole = std::max(mostOfWhole, full);
    }
    EXPECT_LT(sum, 0.7 * whole) << sum << " of " << whole;
    EXPECT_LT(most, 0.7 * mostOfWhole) << most << " of " << mostOfWhole;
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
        for (int firstSide : {2, 1}) {
            const auto ends = directionsOfPair(firstSide);
            const Vec3 first = before[ends[0][1]] - before[ends[0][0]], second = before[ends[1][1]] - before[ends[1][0]];
            if (std::abs(first.normalized().dot(second.normalized())) > 0.9) continue;
            EXPECT_LT((contact::PairTurn(firstSide, {0, 1, 2, 3}, before, now) * u - turn * u).norm(), 1.0e-10);
        }
    }
}

/// What a turn does to a separation along tangents is what its lever makes of the changes of the pair's directions, however they turn and stretch: a force on the
/// one does the work that its moment does on the others.
TEST(PairTurn, DoesWhatItsLeverMakesOfTheChanges)
{
    Noise random(5);
    int parallel = 0;
    for (int i = 0; i < 500; ++i) {
        std::vector<Vec3> before(4);
        for (Vec3& x : before) x = random.vector();
        const int firstSide = 1 + i % 2;
        const auto ends = directionsOfPair(firstSide);
        if (i % 3 == 0) before[ends[1][1]] = before[ends[1][0]] + 1.5 * (before[ends[0][1]] - before[ends[0][0]]) + 0.1 * random.vector();
        std::vector<Vec3> now = before;
        for (Vec3& x : now) x += 0.3 * random.vector();
        const contact::PairTurn turn(firstSide, {0, 1, 2, 3}, before, now);
        const Vec3 u = random.vector();
        const Vec3 normal = random.vector().normalized();
        const std::array<Vec3, 2> tangents = tangentsOf(normal);
        const ActiveContacts::Lever lever = turn.lever(u, tangents);
        Vec3 change = Vec3::Zero();
        std::array<Vec3, 2> direction;
        for (int d = 0; d < 2; ++d) {
            const Vec3 first = before[ends[d][1]] - before[ends[d][0]], last = now[ends[d][1]] - now[ends[d][0]];
            for (int j = 0; j < 2; ++j) change += lever[d][j].dot(last - first) * tangents[j];
            direction[d] = (first.normalized() + last.normalized()).normalized();
        }
        parallel += std::abs(direction[0].dot(direction[1])) > 0.95;
        const Vec3 turned = turn * u - u;
        EXPECT_LT((change - (turned - normal.dot(turned) * normal)).norm(), 1.0e-9) << i;
    }
    EXPECT_GT(parallel, 50);
}

}  // namespace
}  // namespace sim::test
