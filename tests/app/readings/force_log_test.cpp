#include "app/readings/force_log.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace app {
namespace {

/// A step of dt [s] in which liquid pushes a wall, one above the origin, by a force along x [dyn].
sim::Forces pushed(double push, double dt = 0.5)
{
    sim::Forces forces;
    forces.obstacles.resize(1);
    forces.begin(dt);
    forces.obstacles[0].liquid = sim::Impulse::at(sim::Vec3::UnitY(), {dt * push, 0.0, 0.0});
    return forces;
}

nlohmann::ordered_json wallOf(const ForceTotals& totals)
{
    ForceNames names;
    names.obstacles = {"wall"};
    return forcesJson(names, totals).at("obstacles").at("wall").at("liquid");
}

/// Means are impulses over times, whatever the lengths of the steps; a step that took no time tells of no force.
TEST(ForceTotals, MeanIsTheImpulseOverTheTime)
{
    ForceTotals totals;
    EXPECT_EQ(totals.mean(0).linear, sim::Vec3::Zero().eval());
    totals.add(pushed(1.0, 0.2));
    totals.add(pushed(4.0, 0.1));
    totals.add(pushed(9.0, 0.0));
    EXPECT_NEAR(totals.mean(0).linear.x(), 2.0, 1e-12);
    EXPECT_NEAR(totals.mean(0).angular.z(), -2.0, 1e-12);
    EXPECT_EQ(totals.mean(1).linear, sim::Vec3::Zero().eval()) << "by contact";
    EXPECT_NEAR(wallOf(totals).at("largest_force").get<double>(), 4.0, 1e-12);
}

TEST(ForceTotals, TwoStepsAreLargestTogetherWhereTheFirstIsReflected)
{
    ForceTotals totals;
    totals.add(pushed(10.0), true);
    totals.add(pushed(2.0), false);
    totals.add(pushed(5.0), false);
    const auto wall = wallOf(totals);
    EXPECT_EQ(wall.at("largest_force"), 6.0);
    EXPECT_EQ(wall.at("largest_torque"), 6.0);
    EXPECT_NEAR(wall.at("mean_force").at(0).get<double>(), 17.0 / 3.0, 1e-12);
}

}  // namespace
}  // namespace app
