// Liquid at walls that go slanted through the grid slides and rests as at any other.
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

struct Slope {
    double degrees;
    Transfer transfer;
    int cells;         ///< that the liquid is deep
    double yaw = 0.0;  ///< of the way down, and of the walls beside it, about the vertical [degrees]
};

/// A sheet of liquid 1 cm deep and 4 cm long on a slope down x.
Scene sheetOn(const Slope& slope)
{
    const double width = slope.yaw == 0.0 ? 0.5 : 1.0;  // walls that are slanted, too, have corners with the slope
    const double degree = kPi / 180.0;
    Scene scene;
    scene.name = "slope";
    scene.settings.cell = 1.0 / slope.cells;
    scene.settings.transfer.method = slope.transfer.method;
    scene.settings.transfer.modes = slope.transfer.modes;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 8.0e-3 / slope.cells;
    Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
    turn.rotate(Eigen::AngleAxisd(slope.yaw * degree, Vec3::UnitY()));
    const Eigen::Isometry3d yawed = turn;
    turn.rotate(Eigen::AngleAxisd(-slope.degrees * degree, Vec3::UnitZ()));
    scene.obstacles.push_back(obstacle("slope", Shape::box({0.0, -1.0, 0.0}, {80.0, 1.0, width}).moved(turn)));
    scene.obstacles.push_back(obstacle("walls", Shape::box({0.0, 0.0, 0.0}, {90.0, 90.0, width}).inverted().moved(yawed)));
    SourceSettings source;
    source.name = "sheet";
    source.shape = Shape::box({0.0, 0.5, 0.0}, {2.0, 0.5, width}).moved(turn);
    source.emissions.push_back({});
    scene.sources.push_back(source);
    return scene;
}

/// Speed down the slope relative to that of a block, less 1.
double gainedOn(const Slope& slope)
{
    Simulation simulation(sheetOn(slope));
    while (simulation.state().time < 0.2) simulation.step(0.2);
    const State& state = simulation.state();
    const double angle = slope.degrees * kPi / 180.0;
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t p = 0; p < state.liquid.count; ++p) {
        momentum += state.liquid.mass[p] * state.liquid.velocity(p);
        mass += state.liquid.mass[p];
    }
    const double yaw = slope.yaw * kPi / 180.0;
    const Vec3 down(std::cos(angle) * std::cos(yaw), -std::sin(angle), -std::cos(angle) * std::sin(yaw));
    const Vec3 velocity = momentum / mass + state.memory.sinceMidstep;
    return velocity.dot(down) / (kEarthGravity * std::sin(angle) * state.time) - 1.0;
}

void expectWithin(double most, const Slope& slope)
{
    const double gained = gainedOn(slope);
    std::printf("%4.1f degrees, yaw %2.0f, %d cells, %-10s: %+.2f %%\n", slope.degrees, slope.yaw, slope.cells, slope.transfer.name.c_str(),
                100.0 * gained);
    EXPECT_NEAR(gained, 0.0, most) << slope.degrees << " degrees, " << slope.transfer.name;
}

TEST(Slope, LiquidFourCellsDeepSlidesAsABlock)
{
    for (const double degrees : {3.0, 5.0, 8.0, 10.0, 17.0, 26.6, 30.0, 45.0, 60.0, 80.0})
        for (const Transfer& transfer : {kPic, kFlip, kApic, kPoly8, kPoly27}) expectWithin(0.02, {degrees, transfer, 4});
}

TEST(Slope, LiquidEightCellsDeepDoesSoWithinHalfAPercent)
{
    for (const double degrees : {5.0, 10.0, 20.0, 30.0, 45.0, 70.0})
        for (const Transfer& transfer : {kApic, kPoly8, kPoly27}) expectWithin(0.005, {degrees, transfer, 8});
}

/// The way down goes across the grid, between walls that do, too.
TEST(Slope, LiquidSlidesAsABlockAnyWay)
{
    for (const double yaw : {20.0, 45.0})
        for (const double degrees : {3.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 45.0, 70.0}) expectWithin(0.02, {degrees, kPoly8, 4, yaw});
    for (const double degrees : {5.0, 8.0, 12.0, 30.0}) expectWithin(0.005, {degrees, kPoly8, 8, 20.0});
}

/// A pool comes to rest in a tray that is turned on the grid.
TEST(Rest, OfAPoolInATurnedTray)
{
    for (const double degrees : {3.0, 5.0, 12.0, 30.0, 45.0})
        for (const double width : {0.5, 0.4}) {  // a multiple of the cell, and none
            Scene scene;
            scene.name = "tray";
            scene.settings.cell = 0.25;
            scene.settings.time.mode = TimeMode::Fixed;
            scene.settings.time.dt = 2.0e-3;
            Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
            turn.rotate(Eigen::AngleAxisd(-degrees * kPi / 180.0, Vec3::UnitZ()));
            scene.obstacles.push_back(obstacle("tray", Shape::box({0.0, 1.4, 0.0}, {2.0, 2.6, 5.0}).inverted().moved(turn)));
            scene.obstacles.push_back(obstacle("walls", Shape::box({0.0, 0.0, 0.0}, {90.0, 90.0, width}).inverted()));
            SourceSettings source;
            source.name = "pool";
            source.shape = Shape::box({0.0, -1.45, 0.0}, {3.0, 1.55, width});
            source.emissions.push_back({});
            scene.sources.push_back(source);
            Simulation simulation(scene);
            const double start = simulation.energies().total();
            Energies now;
            while (simulation.state().time < 3.0) now = simulation.step(3.0).energies;
            double mass = 0.0;
            for (std::size_t p = 0; p < simulation.state().liquid.count; ++p) mass += simulation.state().liquid.mass[p];
            const double speed = std::sqrt(2.0 * now.kinetic / mass), risen = (now.total() - start) / (mass * kEarthGravity);
            std::printf("%4.1f degrees, %.1f cm: %.3f cm/s, risen by %.4f cm\n", degrees, width, speed, risen);
            EXPECT_LT(speed, 0.1) << degrees << " degrees";
            EXPECT_LT(risen, 1.0e-3) << degrees << " degrees";
        }
}

}  // namespace
}  // namespace sim::test
