#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// An upright channel of four cells' width and more, with liquid 3 cm deep on a floor of its own that reaches into the channel's walls.
struct Channel {
    double wider = 0.0;     ///< walls stand by as much of a cell outside of faces
    double degrees = 0.0;   ///< it is turned about the vertical
    double higher = 0.0;    ///< the floor, by as much of a cell
    double friction = 0.0;  ///< of walls
    double speed = 0.0;     ///< of the floor and the liquid, upwards [cm/s]

    std::string text() const
    {
        return std::to_string(wider) + " cells wider, turned by " + std::to_string(degrees) + ", floor " + std::to_string(higher) +
               " cells up, friction " + std::to_string(friction);
    }
    Scene scene() const
    {
        constexpr double kCell = 0.5;
        const double half = 2.0 + wider * kCell, floor = higher * kCell;
        const Eigen::Isometry3d turn(Eigen::AngleAxisd(degrees * kPi / 180.0, Vec3::UnitY()));
        Scene scene;
        scene.name = "channel";
        scene.settings.cell = kCell;
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 2.0e-3;
        scene.settings.liquid.wallFriction = friction;
        Motion motion;
        if (speed != 0.0) motion.addTranslation(0.0, 1.0, speed * Vec3::UnitY(), 0.0, 0.0);
        scene.obstacles = {obstacle("channel", Shape::box({0.0, 4.0, 0.0}, {half, 8.0, half}).inverted().moved(turn)),
                           obstacle("floor", Shape::box({0.0, floor - 1.0, 0.0}, {half + 1.0, 1.0, half + 1.0}).moved(turn), motion)};
        SourceSettings liquid;
        liquid.name = "liquid";
        liquid.shape = Shape::box({0.0, floor + 1.5, 0.0}, {half, 1.5, half}).moved(turn);
        liquid.emissions.push_back({});
        liquid.emissions[0].velocity = speed * Vec3::UnitY();
        scene.sources = {liquid};
        return scene;
    }
};

std::vector<Channel> channels(const std::vector<double>& frictions, double speed)
{
    std::vector<Channel> all;
    for (const double wider : {0.0, 0.3, 0.5, 0.8})
        for (const double degrees : {0.0, 20.0})
            for (const double higher : {0.0, 0.3, 0.7})
                for (const double friction : frictions) all.push_back({wider, degrees, higher, friction, speed});
    return all;
}

double heightOf(const LiquidParticles& liquid)
{
    double mass = 0.0, moment = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        mass += liquid.mass[p];
        moment += liquid.mass[p] * liquid.x[1][p];
    }
    return moment / mass;
}

/// All of the weight of liquid at rest is on its floor, wherever walls cut the faces of the grid, and none on the walls around.
TEST(Channel, WeightOfLiquidIsOnItsFloor)
{
    for (const Channel& channel : channels({0.0, 1.0}, 0.0)) {
        Simulation simulation(channel.scene());
        const double weight = simulation.state().ledger.emittedMass * kEarthGravity;
        for (int step = 0; step < 20; ++step) simulation.step(1.0e9);
        Vec3 onFloor = Vec3::Zero(), onWalls = Vec3::Zero();
        constexpr int kSteps = 20;
        for (int step = 0; step < kSteps; ++step) {
            simulation.step(1.0e9);
            onWalls += simulation.forces().obstacles[0].liquid.linear / (simulation.forces().dt * kSteps * weight);
            onFloor += simulation.forces().obstacles[1].liquid.linear / (simulation.forces().dt * kSteps * weight);
        }
        EXPECT_LT((onFloor + Vec3::UnitY()).norm(), 0.015) << channel.text();
        EXPECT_LT(onWalls.norm(), 0.015) << channel.text();
    }
}

/// A piston carries what is above it along, as far as it goes itself.
TEST(Channel, PistonsCarryLiquidAlong)
{
    for (const Channel& channel : channels({0.0}, 5.0)) {
        Simulation simulation(channel.scene());
        const double start = heightOf(simulation.state().liquid);
        for (int step = 0; step < 40; ++step) simulation.step(1.0e9);
        EXPECT_NEAR((heightOf(simulation.state().liquid) - start) / (channel.speed * simulation.state().time), 1.0, 0.025) << channel.text();
    }
}

}  // namespace
}  // namespace sim::test
