#include "sim/stages/correction.h"
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

TEST(Stages, RunOnlyWhereTheyAreNeeded)
{
    Scene scene;
    scene.settings.cell = 0.5;
    scene.settings.liquid.volume.rate = 0.0;
    scene.settings.time.integrator = TimeIntegrator::Plain;
    SourceSettings source;
    source.shape = Shape::ball(Vec3::Zero(), 2.0);
    source.emissions.push_back({});
    scene.sources.push_back(source);
    const StepReport report = Simulation(scene).step(1.0e9);
    for (Stage stage : {Stage::Emit, Stage::Obstacles, Stage::Relax, Stage::SurfaceTension, Stage::Volume, Stage::Reflection, Stage::Walls})
        EXPECT_FALSE(report.stageRan[static_cast<int>(stage)]);
    for (Stage stage : {Stage::Sort, Stage::ParticlesToGrid, Stage::Cells, Stage::Pressure, Stage::GridToParticles})
        EXPECT_TRUE(report.stageRan[static_cast<int>(stage)]) << kStageNames[static_cast<int>(stage)];

    Scene everything = ballIntoPool(kPoly8);
    everything.settings.liquid.relax.rate = 125.0;
    everything.settings.liquid.surfaceTensionForce = true;
    const StepReport more = Simulation(everything).step(1.0e9);
    for (Stage stage : {Stage::Obstacles, Stage::Relax, Stage::SurfaceTension, Stage::Volume, Stage::Walls})
        EXPECT_TRUE(more.stageRan[static_cast<int>(stage)]) << kStageNames[static_cast<int>(stage)];
}

TEST(Stages, AnEmptySceneRunsThrough)
{
    Scene scene;
    scene.settings.cell = 0.5;
    Simulation simulation(scene);
    for (int step = 0; step < 3; ++step) {
        const StepReport report = simulation.step(1.0);
        EXPECT_EQ(report.particles, 0u);
        EXPECT_EQ(report.liquidCells, 0u);
        EXPECT_TRUE(report.failure.empty());
    }
}

/// A correction waits until several short steps together would correct the gentle share, and no longer.
TEST(Correction, IsDueWhenTheGentleShareIs)
{
    constexpr double kRate = 125.0;  // 1/s: 1.6e-3 s are the gentle share
    EXPECT_FALSE(isDue(kRate, 0.0, 1.0e-3));
    EXPECT_FALSE(isDue(kRate, 1.4e-3, 2.0e-4));
    EXPECT_TRUE(isDue(kRate, 1.4e-3, 2.1e-4));
    EXPECT_TRUE(isDue(kRate, 0.0, 1.0e-2)) << "a long step";
    EXPECT_FALSE(isDue(0.0, 1.0e3, 1.0)) << "what is off is never due";
}

}  // namespace
}  // namespace sim::test
