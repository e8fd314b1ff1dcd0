// Forces on solids, fabrics and pins: action and reaction, and what is known of some of them.
#include "tests/physics/closed_step.h"

#include "tests/physics/fabric_runs.h"
#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace sim::test {
namespace {

/// Water at rest in a tank of 16 x 20 x 16 cells of 0.5 cm, up to the 14th, with a ball of 3 cells in it.
Scene dippedBall(const Transfer& transfer, double friction)
{
    Scene scene = tankScene(transfer, 0.5, {16.0, 20.0, 16.0}, {0.0, 0.0, 0.0}, {16.0, 14.0, 16.0});
    scene.obstacles.push_back(obstacle("ball", Shape::ball({4.0, 3.5, 4.0}, 1.5)));
    scene.settings.liquid.wallFriction = friction;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 2.0e-3;
    return scene;
}

class DippedBall : public ::testing::TestWithParam<double> {};

TEST_P(DippedBall, FeelsTheWeightOfTheWaterInItsPlace)
{
    Simulation simulation(dippedBall(kPoly8, GetParam()));
    constexpr int kSteps = 100, kFrom = 40;
    Vec3 onBall = Vec3::Zero(), onTank = Vec3::Zero(), torque = Vec3::Zero();
    for (int step = 0; step < kSteps; ++step) {
        const ClosedStep closed(simulation);
        ASSERT_LT(closed.error, kExact * closed.exchanged);
        if (step < kFrom) continue;
        const Forces& forces = simulation.forces();
        onBall += forces.obstacles[1].sum().linear / (forces.dt * (kSteps - kFrom));
        torque += forces.obstacles[1].sum().angular / (forces.dt * (kSteps - kFrom));
        onTank += forces.obstacles[0].sum().linear / (forces.dt * (kSteps - kFrom));
    }
    const double buoyancy = 4.0 / 3.0 * kPi * 1.5 * 1.5 * 1.5 * kEarthGravity, weight = massOfLiquid(simulation) * kEarthGravity;
    EXPECT_NEAR(onBall.y() / buoyancy, 1.0, GetParam() < 1.0 ? 0.04 : 0.08);  // of a radius of 3 cells; 0.004 of 6
    EXPECT_LT(std::hypot(onBall.x(), onBall.z()), 1.0e-4 * buoyancy);
    EXPECT_LT((torque - Vec3(4.0, 3.5, 4.0).cross(onBall)).norm(), 1.0e-4 * buoyancy * 1.5);
    EXPECT_LT((onBall + onTank + weight * Vec3::UnitY()).norm(), 1.0e-3 * weight);
}

INSTANTIATE_TEST_SUITE_P(Friction, DippedBall, ::testing::Values(0.0, 0.5, 1.0));

TEST(Forces, AreAllThatChangesMomentum)
{
    for (const Transfer& transfer : {kFlip, kApic, kPoly8, kPoly27})
        for (const double friction : {0.0, 0.3, 1.0})
            for (const bool isViscous : {false, true}) {
                SCOPED_TRACE(transfer.name + ", friction " + std::to_string(friction) + (isViscous ? ", viscous" : ""));
                Scene scene = dippedBall(transfer, friction);
                scene.sources[0].emissions[0].velocity = Vec3(20.0, 0.0, 10.0);
                scene.settings.liquid.surfaceTensionForce = true;
                scene.settings.liquid.solveViscosity = isViscous;
                scene.settings.liquid.viscosity = 5.0;
                Motion motion;
                motion.addOscillation(0.0, 100.0, Vec3::UnitX(), 5.0, 0.5);
                scene.obstacles[1].motion = motion;
                Simulation simulation(scene);
                for (int step = 0; step < 4; ++step) {
                    const ClosedStep closed(simulation);
                    EXPECT_LT(closed.error, kExact * closed.exchanged);
                    const MomentumBalance& balance = simulation.forces().balance;
                    EXPECT_EQ(balance.unresolved, Vec3::Zero());
                    EXPECT_LT(balance.borne.norm(), 6.0e-3 * closed.exchanged);
                    EXPECT_GT(balance.change.norm(), 0.01 * balance.weight.norm());
                    EXPECT_GT(simulation.forces().obstacles[1].liquid.linear.norm(), 0.01 * closed.exchanged);
                }
            }
}

/// Viscous drops beside a ball that comes and goes: its stresses reach faces that have nothing of the liquid.
TEST(Forces, OfViscosityReachSolidsAcrossFacesWithoutLiquid)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    double most = 0.0;
    for (int n = 0; n < 18; ++n) {
        SCOPED_TRACE(n);
        const Transfer& transfer = n % 2 == 0 ? kApic : kPoly8;
        Scene scene = tankScene(transfer, 0.4, {40.0, 40.0, 40.0}, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
        const Vec3 middle(8.0, 8.0, 8.0), way = Vec3(unit(random), unit(random), unit(random)).normalized();
        scene.sources[0].shape = Shape::ball(middle + 0.3 * Vec3(unit(random), unit(random), unit(random)), 0.6);
        scene.settings.liquid.solveViscosity = true;
        scene.settings.liquid.viscosity = std::pow(10.0, 3.0 + unit(random));
        scene.settings.liquid.wallFriction = n % 3 == 0 ? 0.5 : 0.0;
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 2.0e-4;
        Motion motion;
        motion.addOscillation(0.0, 1.0, way, 0.4, 100.0);
        scene.obstacles.push_back(obstacle("ball", Shape::ball(middle - (1.2 + 0.2 * unit(random)) * way, 0.5), motion));
        Simulation simulation(scene);
        for (int step = 0; step < 40; ++step) {
            const ClosedStep closed(simulation);
            // Surface faces that count as full leave up to .022 of it; all of it where such faces were left out.
            EXPECT_LT(simulation.forces().balance.unresolved.norm(), 0.05 * closed.exchanged) << step;
            most = std::max(most, simulation.forces().obstacles[1].sum().linear.norm() / simulation.forces().balance.weight.norm());
        }
    }
    EXPECT_GT(most, 10.0) << "the ball pulls";
}

TEST(Forces, AreTheSameOnAnyNumberOfThreads)
{
    const auto forcesOn = [](int threads) {
        return onThreads(threads, [] {
            Simulation simulation(dippedBall(kPoly8, 0.0));
            for (int step = 0; step < 3; ++step) simulation.step(1.0e9);
            return simulation.forces().obstacles;
        });
    };
    const std::vector<Load> one = forcesOn(1);
    for (const int threads : {2, 8}) {
        const std::vector<Load> other = forcesOn(threads);
        for (std::size_t n = 0; n < one.size(); ++n) {
            EXPECT_EQ(one[n].liquid.linear, other[n].liquid.linear);
            EXPECT_EQ(one[n].liquid.angular, other[n].liquid.angular);
        }
    }
}

}  // namespace
}  // namespace sim::test
