#include "sim/fabric/vertex/bossak.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

// A vertex by itself (fabric/vertex/README.md, Second order).

namespace sim::bossak {
namespace {

using sim::testing::Noise;

Vertex anyVertex(Noise& noise, double drag)
{
    const double mass = 2.0 + noise();
    const Vec3 d = drag * mass * (Vec3::Constant(1.5) + noise.vector());
    return {mass, d, 10.0 * noise.vector(), 3.0 * noise.vector(), 50.0 * noise.vector(), 980.0 * noise.vector(), 1.0e-3 * (1.5 + noise())};
}

TEST(Bossak, MomentumIsWhatForcesImpulsesAndTheLiquidGave)
{
    Noise noise(7);
    for (int n = 0; n < 200; ++n) {
        const double drag = n % 4 == 0 ? 0.0 : std::pow(10.0, n % 7 - 3);
        const Vertex at = anyVertex(noise, drag);
        const Vec3 move = noise.vector(), abrupt = 100.0 * noise.vector();
        const Rates rates = ratesOf(at, move, abrupt);
        const Vec3 lasting = 2.0 * rates.force - at.force;
        const Vec3 byLiquid = at.impulse - at.drag.cwiseProduct(rates.velocity);
        const Vec3 given = at.h * (0.25 * (at.force + 3.0 * lasting) + abrupt + at.mass * at.gravity) + byLiquid;
        const Vec3 got = at.mass * (rates.velocity - at.velocity);
        EXPECT_LT((got - given).norm(), 1.0e-9 * (got.norm() + given.norm() + byLiquid.norm()) * (1.0 + drag)) << n;
        EXPECT_LT((rates.own - (0.25 * (at.force + 3.0 * lasting) + abrupt) / at.mass).norm(), 1.0e-9 * rates.own.norm());
    }
}

TEST(Bossak, FallsExactlyWhateverTheSteps)
{
    Noise noise(7);
    Vertex at{2.0, Vec3::Zero(), Vec3::Zero(), Vec3(1.0, 2.0, 3.0), Vec3::Zero(), Vec3(0.0, -980.0, 5.0), 0.0};
    const Vec3 start = at.velocity;
    Vec3 x = Vec3::Zero();
    double t = 0.0;
    for (int n = 0; n < 100; ++n) {
        at.h = 1.0e-3 * (1.1 + noise());
        const Vec3 move = at.freeMove();
        const Rates rates = ratesOf(at, move, Vec3::Zero());
        x += move, t += at.h;
        at.velocity = rates.velocity, at.force = rates.force;
        EXPECT_LT(at.force.norm(), 1.0e-8);
    }
    EXPECT_LT((at.velocity - start - t * at.gravity).norm(), 1.0e-10);
    EXPECT_LT((x - t * start - 0.5 * t * t * at.gravity).norm(), 1.0e-10);
}

/// A spring between the vertex and the origin.
struct Spring {
    double rate;  // 1/s
    Vertex at;
    Vec3 x;

    double energy() const { return 0.5 * at.mass * (at.velocity.squaredNorm() + rate * rate * x.squaredNorm()); }
    void step()
    {
        const Vec3 inertia = at.inertia() / (at.h * at.h);
        const Vec3 stiffness = Vec3::Constant(at.mass * rate * rate);
        const Vec3 end = inertia.cwiseProduct(x + at.freeMove()).cwiseQuotient(inertia + stiffness);
        const Rates rates = ratesOf(at, end - x, Vec3::Zero());
        x = end, at.velocity = rates.velocity, at.force = rates.force;
    }
};

Spring springOf(double rate, double h)
{
    Spring spring{rate, {2.0, Vec3::Zero(), Vec3::Zero(), Vec3(0.0, rate, 0.0), Vec3::Zero(), Vec3::Zero(), h}, Vec3(1.0, 0.0, 0.5)};
    return spring;
}

TEST(Bossak, SpringsAreOfSecondOrderAndKeepTheirEnergy)
{
    std::array<double, 4> error{};
    for (int level = 0; level < 4; ++level) {
        const int steps = 40 << level;
        Spring spring = springOf(2.0 * kPi, 1.0 / steps);
        spring.at.force = -spring.at.mass * std::pow(spring.rate, 2) * spring.x;
        const Vec3 start = spring.x;
        for (int n = 0; n < steps; ++n) spring.step();
        error[level] = (spring.x - start).norm();
    }
    for (int level = 1; level < 4; ++level) EXPECT_GT(std::log2(error[level - 1] / error[level]), 1.85) << level;
    Spring spring = springOf(2.0 * kPi, 1.0 / 400);
    spring.at.force = -spring.at.mass * std::pow(spring.rate, 2) * spring.x;
    const double energy = spring.energy();
    for (int n = 0; n < 400 * 5; ++n) {
        spring.step();
        EXPECT_LT(spring.energy(), 1.0001 * energy);
    }
    EXPECT_GT(spring.energy(), 0.98 * energy);
}

TEST(Bossak, StiffSpringsEndInAFewSteps)
{
    for (const double perStep : {10.0, 100.0, 1000.0}) {
        Spring spring = springOf(perStep / 1.0e-3, 1.0e-3);
        const double energy = spring.energy();
        double most = 0.0;
        for (int n = 0; n < 6; ++n) {
            spring.step();
            most = std::max(most, spring.energy());
        }
        EXPECT_LT(most, 1.1 * energy) << perStep;
        EXPECT_LT(spring.energy(), 1.0e-2 * energy) << perStep;
    }
}

/// What sinks steadily moves as fast as its velocity says, whatever the liquid does to it in a step.
TEST(Bossak, TerminalVelocityIsThatOfTheDrag)
{
    for (const double drag : {1.0e-2, 1.0, 30.0}) {
        const double mass = 2.0, h = 1.0e-3, flow = 3.0;
        Vertex at{mass, Vec3::Constant(drag * mass), Vec3::Constant(drag * mass * flow), Vec3::Zero(), Vec3::Constant(-980.0), Vec3::Constant(-980.0),
                  h};
        Vec3 move = Vec3::Zero();
        for (int n = 0; n < 4000; ++n) {
            move = at.freeMove();
            const Rates rates = ratesOf(at, move, Vec3::Zero());
            at.velocity = rates.velocity, at.force = rates.force;
        }
        const double terminal = flow - 980.0 * h / drag;
        EXPECT_NEAR(at.velocity.x(), terminal, 1.0e-9 * std::abs(terminal)) << drag;
        EXPECT_NEAR(move.x() / h, terminal, 1.0e-9 * std::abs(terminal)) << drag;
    }
}

/// What is stopped within a step is at rest at its end, but for half a step of its weight.
TEST(Bossak, InelasticImpulsesDoNotRebound)
{
    Vertex at{2.0, Vec3::Zero(), Vec3::Zero(), Vec3(0.0, -100.0, 0.0), Vec3::Zero(), Vec3(0.0, -980.0, 0.0), 1.0e-3};
    const Vec3 stopping = -at.inertia().cwiseProduct(at.freeMove()) / (at.h * at.h);
    const Rates rates = ratesOf(at, Vec3::Zero(), 0.5 * stopping);
    EXPECT_NEAR(rates.velocity.y(), -0.5 * 980.0 * at.h, 1.0e-9);
    const Rates alike = ratesOf(at, Vec3::Zero(), Vec3::Zero());
    EXPECT_GT(alike.velocity.y(), 45.0) << "which is what it would be";
}

}  // namespace
}  // namespace sim::bossak
