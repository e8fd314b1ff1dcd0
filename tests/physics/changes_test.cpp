#include "sim/particles/velocity_modes.h"
#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

// Runs whose settings change on the way.

namespace sim::test {
namespace {

Scene column(const Transfer& transfer)
{
    Scene scene = tankScene(transfer, 0.5, {12.0, 12.0, 4.0}, {0.0, 0.0, 0.0}, {5.0, 7.0, 4.0});
    scene.settings.time.dt = 2.0e-3;
    return scene;
}

SettingsChange change(const Scene& scene, std::int64_t step)
{
    SettingsChange change = {.step = step, .settings = scene.settings, .materials = scene.materials};
    change.settings.time.dt = 1.0e-3;
    change.settings.gravity = {200.0, -900.0, 0.0};
    change.settings.transfer.method = TransferMethod::PolyPic;
    change.settings.transfer.modes = 27;
    return change;
}

std::uint64_t runTo(Simulation& simulation, std::int64_t step)
{
    while (simulation.state().step < step) simulation.step(1.0e9);
    return stateHash(simulation.state());
}

TEST(ChangingRun, GoesOnLikeARunOfTheChangedSceneFromThere)
{
    for (const Transfer& transfer : kTransfers) {
        Scene scene = column(transfer), changed = scene;
        scene.changes = {change(scene, 8)};
        changed.settings = scene.changes[0].settings;
        Simulation whole(scene), before(column(transfer));
        runTo(before, 7);
        State state = before.state();
        state.liquid.changeModes(storedModes(27));
        Simulation after(changed, state);
        EXPECT_EQ(runTo(whole, 12), runTo(after, 12)) << transfer.name;
        EXPECT_EQ(whole.scene().settings.time.dt, 1.0e-3);
        EXPECT_NE(runTo(before, 12), stateHash(whole.state())) << "it makes a difference";
    }
}

TEST(ChangingRun, IsResumedWithWhatHeldThen)
{
    Scene scene = column(kPoly8);
    scene.changes = {change(scene, 4), change(scene, 8)};
    scene.changes[1].settings.gravity = Vec3::Zero();
    Simulation whole(scene);
    for (const std::int64_t step : {3, 4, 6, 7, 8}) {
        Simulation first(scene);
        runTo(first, step);
        Simulation second(scene, first.state());
        Simulation uninterrupted(scene);
        EXPECT_EQ(runTo(second, 10), runTo(uninterrupted, 10)) << "resumed after step " << step;
    }
}

TEST(ChangingRun, ChangesGivenWhileItRunsAreThoseOfTheScene)
{
    Scene scene = column(kPoly8);
    Simulation live(scene);
    runTo(live, 5);
    scene.changes = {change(scene, 6)};
    live.setChanges(scene.changes);
    Simulation whole(scene);
    EXPECT_EQ(runTo(live, 9), runTo(whole, 9));
}

TEST(ChangingRun, ParticlesKeepTheirVelocities)
{
    Simulation simulation(column(kPoly27));
    runTo(simulation, 10);
    LiquidParticles liquid = simulation.state().liquid;
    std::vector<Vec3> before;
    for (std::size_t p = 0; p < liquid.count; ++p) before.push_back(liquid.velocity(p));
    for (const int modes : {11, 8, 4, 1, 27, 1}) {
        liquid.changeModes(modes);
        ASSERT_EQ(liquid.modeCount, modes);
        for (std::size_t p = 0; p < liquid.count; ++p) ASSERT_LT((liquid.velocity(p) - before[p]).norm(), 1.0e-10) << modes << " modes, of 1e2 cm/s";
    }
}

}  // namespace
}  // namespace sim::test
