#include "sim/fabric/pieces/generators.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <cmath>

// Steps that turn out bad are rejected and made again half as long: time.mode adaptive.

namespace sim::test {
namespace {

constexpr double kJetStart = 0.02;  ///< [s]

/// A jet at `speed` goes for a column that collapses, in blocks that were not there before. Nothing tells the step in
/// which it begins how fast it will be.
Scene columnAndJet(const Transfer& transfer, double speed = 1000.0)
{
    Scene scene = tankScene(transfer, 1.0, {24.0, 16.0, 8.0}, {12.0, 0.0, 0.0}, {24.0, 5.0, 8.0});
    scene.settings.time.mode = TimeMode::Adaptive;
    scene.settings.time.dt = 5.0e-3;
    SourceSettings jet;
    jet.name = "jet";
    jet.shape = Shape::ball({3.0, 4.0, 4.0}, 1.5);
    jet.emissions.push_back({.from = kJetStart, .to = kJetStart + 0.004, .velocity = {speed, 0.0, 0.0}});
    scene.sources.push_back(jet);
    return scene;
}

/// The same, while a ball stirs the column.
Scene stirredColumnAndJet()
{
    Scene scene = columnAndJet(kPoly8);
    Motion motion;
    motion.addOscillation(0.0, 100.0, Vec3::UnitX(), 4.0, 2.0);
    scene.obstacles.push_back(obstacle("ball", Shape::ball({18.0, 5.0, 4.0}, 1.5), motion));
    return scene;
}

/// A column and a jet with a sheet of cloth in the jet's way.
Scene columnJetAndCloth(FabricSolver solver)
{
    Scene scene = columnAndJet(kPoly8);
    scene.settings.fabric.solver = solver;
    FabricPiece cloth = testing::pieceOf(clothGrid({{9, 9}, {0.5, 0.5}, Vec3(4.0, 4.0, 2.0)}), testing::wool(), {0.0165, 0.018});
    cloth.material.volumeFraction = 0.4;
    scene.fabrics.push_back(cloth);
    return scene;
}

struct Retry {
    int rejectedSteps = 0;
    double dt = 0.0;
    std::uint64_t after = 0, fromBefore = 0;
};

/// The first step that was rejected, and the same step from the state before, in another program as it were.
Retry firstRetry(const Scene& scene)
{
    Simulation simulation(scene);
    while (simulation.state().time < 0.1) {
        const State before = simulation.state();
        const StepReport report = simulation.step(0.1);
        if (report.rejectedSteps == 0) continue;
        Scene calm = scene;
        calm.settings.time.mode = TimeMode::Fixed;
        calm.settings.time.dt = report.dt;
        calm.settings.time.maxCflLiquid = 1.0e9;
        Simulation other(calm, before);
        other.step(0.1);
        return {report.rejectedSteps, report.dt, stateHash(simulation.state()), stateHash(other.state())};
    }
    return {};
}

TEST(Adaptive, ARetriedStepBeginsFromTheStateBefore)
{
    std::vector<std::pair<std::string, Scene>> scenes;
    for (const Transfer& transfer : {kFlip, kApic, kPoly8, kPoly27}) scenes.emplace_back(transfer.name, columnAndJet(transfer));
    scenes.emplace_back("stirred", stirredColumnAndJet());
    scenes.emplace_back("vertex", columnJetAndCloth(FabricSolver::Vertex));
    scenes.emplace_back("grid", columnJetAndCloth(FabricSolver::Grid));
    for (const auto& [name, scene] : scenes) {
        const Retry retry = firstRetry(scene);
        EXPECT_GE(retry.rejectedSteps, 1) << name;
        EXPECT_EQ(retry.after, retry.fromBefore) << name;
    }
}

TEST(Adaptive, SameBitsOnAnyNumberOfThreads)
{
    const auto run = [](int threads) {
        return onThreads(threads, [] {
            Simulation simulation(columnJetAndCloth(FabricSolver::Vertex));
            int rejectedSteps = 0;
            while (simulation.state().time < 0.04) rejectedSteps += simulation.step(0.04).rejectedSteps;
            return std::pair(rejectedSteps, stateHash(simulation.state()));
        });
    };
    const auto one = run(1);
    EXPECT_GE(one.first, 1);
    EXPECT_EQ(run(2), one);
    EXPECT_EQ(run(8), one);
}

/// Where no step is bad it is what mode cfl does.
TEST(Adaptive, IsModeCflWhereNothingIsBad)
{
    const auto run = [](TimeMode mode) {
        Scene scene = coarseDamBreak(kPoly8);
        scene.settings.time.mode = mode;
        Simulation simulation(scene);
        int rejectedSteps = 0;
        while (simulation.state().time < 0.3) rejectedSteps += simulation.step(0.3).rejectedSteps;
        EXPECT_EQ(rejectedSteps, 0);
        return stateHash(simulation.state());
    };
    EXPECT_EQ(run(TimeMode::Adaptive), run(TimeMode::Cfl));
}

/// A short jet that leaves through the domain's other side.
TEST(Adaptive, StepsGrowAgain)
{
    Scene scene = columnAndJet(kPoly8);
    scene.sources.erase(scene.sources.begin());
    scene.obstacles.clear();
    scene.settings.gravity.setZero();
    scene.domain = Shape::box({12.0, 8.0, 4.0}, {12.0, 8.0, 4.0});
    Simulation simulation(scene);
    double shortest = 1.0, last = 0.0;
    int rejectedSteps = 0;
    while (simulation.state().time < 0.2) {
        const StepReport report = simulation.step(1.0);
        rejectedSteps += report.rejectedSteps;
        shortest = std::min(shortest, report.dt);
        last = report.dt;
    }
    EXPECT_GE(rejectedSteps, 1);
    EXPECT_LT(shortest, 3.0e-3);
    EXPECT_NEAR(last, 5.0e-3, 1.0e-4);
}

/// A jet so fast that the squares of its speeds are not numbers.
TEST(Adaptive, GivesUpWithTheLastGoodState)
{
    Scene scene = columnAndJet(kPoly8, 1.0e200);
    scene.settings.time.integrator = TimeIntegrator::Plain;  // one of its steps begins just with the jet, which cannot have moved yet
    Simulation simulation(scene);
    std::uint64_t last = 0;
    try {
        while (simulation.state().time < 0.1) {
            last = stateHash(simulation.state());
            simulation.step(0.1);
        }
        FAIL() << "it went on";
    } catch (const RunError& error) {
        const std::string message = error.what();
        for (const char* part :
             {"scene tank, step 5, ", "stage grid_to_particles: velocities are not finite: particle ", "10 halvings of the step", "try "})
            EXPECT_NE(message.find(part), std::string::npos) << message;
    }
    EXPECT_EQ(stateHash(simulation.state()), last);
    for (std::size_t p = 0; p < simulation.state().liquid.count; ++p) ASSERT_LT(simulation.state().liquid.velocity(p).norm(), 1.0e3);
}

TEST(Adaptive, TellsHowOftenAndWhatItCost)
{
    Simulation simulation(columnAndJet(kPoly8));
    while (simulation.state().time < 0.1) {
        const StepReport report = simulation.step(0.1);
        EXPECT_TRUE(report.stageRan[static_cast<int>(Stage::Backup)]);
        EXPECT_EQ(report.stageRan[static_cast<int>(Stage::Rejected)], report.rejectedSteps > 0);
    }
    Scene fixed = columnAndJet(kPoly8, 10.0);
    fixed.settings.time.mode = TimeMode::Fixed;
    EXPECT_FALSE(Simulation(fixed).step(1.0).stageRan[static_cast<int>(Stage::Backup)]);
}

/// How long steps may be after one was rejected is part of the state: a run that is gone on with starts with no longer ones.
TEST(Adaptive, IsResumedWithStepsAsLongAsTheyMayBe)
{
    const Scene scene = coarseDamBreak(kPoly8);
    Simulation whole(scene);
    whole.step(1.0);
    whole.step(1.0);
    State state = whole.state();
    const double usual = Simulation(scene, state).step(1.0).dt;
    state.memory.longest = 0.1 * usual;
    Simulation resumed(scene, state);
    for (int step = 0; step < 4; ++step) EXPECT_LE(resumed.step(1.0).dt, 0.1 * usual * std::pow(1.2, step) * (1.0 + 1.0e-9)) << step;
}

}  // namespace
}  // namespace sim::test
