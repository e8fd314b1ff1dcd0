#include "app/lab/random/escapes.h"

#include "app/checkpoint/checkpoint.h"
#include "app/checkpoint/state_files.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"
#include "tests/app/temporary_folder.h"

namespace app {
namespace {

/// A cup of 4 × 4 × 4 cm with a plate in it, a turned one beside it, liquid, and a cloth over it of which two corners are held. The plate
/// moves by 1 cm in a second.
constexpr const char* kScene = R"(drench: 1
grid: {cell: 0.5}
liquid: {sources: [{name: pool, shape: {box: {min: [-1.8, 0.1, -1.8], max: [-0.5, 1.0, 1.8]}}}]}
materials: {wool: {young: 5.0e+5}}
fabrics:
  - name: sheet
    cloth_grid: {material: wool, nodes: [5, 5], spacing: 0.3, center: [-1, 2, 0], u: [1, 0, 0], v: [0, 0, 1], radius: 0.02}
    pin: {nodes: [0, 1]}
obstacles:
  - {name: floor, shape: {box: {min: [-3, -1, -3], max: [3, 0, 3]}}}
  - {name: plate, shape: {box: {min: [0, 0, -2], max: [0.1, 3, 2]}}, motion: [{t: [0, 1], translate: [1, 0, 0]}]}
)";

/// A run that has kept one state.
struct KeptRun {
    test::TemporaryFolder folder;
    sim::State state;
    std::optional<Eigen::AlignedBox3d> vessel = Eigen::AlignedBox3d(sim::Vec3(-2.0, 0.0, -2.0), sim::Vec3(2.0, 4.0, 2.0));

    explicit KeptRun(const std::string& scene = kScene)
    {
        test::writeFile(folder / "scene.yaml", scene);
        state = sim::Simulation(sim::loadScene(folder / "scene.yaml")).state();
    }
    void place(std::size_t particle, const sim::Vec3& x)
    {
        for (int a = 0; a < 3; ++a) state.liquid.x[a][particle] = x[a];
    }
    std::string told()
    {
        std::filesystem::create_directories(stateFolder(folder.path(), StateKind::ForResuming));
        saveCheckpoint({}, state, stateFile(folder.path(), StateKind::ForResuming, 1));
        return describeEscape(folder / "scene.yaml", folder.path(), vessel);
    }
};

TEST(Escapes, NothingOfASoundState)
{
    KeptRun run;
    EXPECT_EQ(describeEscape(run.folder / "scene.yaml", run.folder.path(), run.vessel), "") << "nothing is kept yet";
    EXPECT_EQ(run.told(), "");
    run.vessel.reset();
    EXPECT_EQ(run.told(), "");
    run.place(0, {0.0, -0.005, 1.0});  // a hundredth of a cell deep
    EXPECT_EQ(run.told(), "");
}

TEST(Escapes, ParticlesInSolidsAreCounted)
{
    KeptRun run;
    run.place(0, {1.0, -0.25, 1.0});
    run.place(1, {1.0, -0.5, 1.0});
    const std::string told = run.told();
    EXPECT_NE(told.find("2 particles inside of solids, up to 0.5 cm"), std::string::npos) << told;
    EXPECT_NE(told.find("2 particles outside of the vessel"), std::string::npos) << told;
    EXPECT_EQ(told.find("vertices"), std::string::npos) << told;
}

TEST(Escapes, ParticlesOutOfTheVesselAreCounted)
{
    KeptRun run;
    run.place(5, {2.5, 1.0, 0.0});
    EXPECT_EQ(run.told(), "1 particles outside of the vessel ");
    run.vessel.reset();
    EXPECT_EQ(run.told(), "");
}

TEST(Escapes, ParticlesThatBeganOutOfTheVesselAreNotCounted)
{
    std::string scene = kScene;
    const std::string pool = "[-0.5, 1.0, 1.8]}}}";
    scene.replace(scene.find(pool), pool.size(), "[-0.5, 1.0, 1.8]}}}, {name: above, shape: {box: {min: [-1, 4.5, -1], max: [0, 5, 1]}}}");
    KeptRun run(scene);
    EXPECT_EQ(run.told(), "");
    std::size_t within = 0;
    while (run.state.liquid.position(within).y() > 4.0) ++within;
    run.place(within, {2.5, 1.0, 0.0});
    EXPECT_EQ(run.told(), "1 particles outside of the vessel ");
}

TEST(Escapes, SolidsAreWhereTheyAreAtTheTimeOfTheState)
{
    KeptRun run;
    run.place(0, {0.05, 1.0, 0.0});
    EXPECT_NE(run.told().find("1 particles inside of solids, up to 0.05 cm"), std::string::npos) << run.told();
    run.state.time = 0.5;
    EXPECT_EQ(run.told(), "") << "the plate has gone";
    run.place(0, {0.55, 1.0, 0.0});
    EXPECT_NE(run.told().find("1 particles inside of solids"), std::string::npos) << run.told();
}

TEST(Escapes, VerticesInAPlateOrOutOfTheVesselAreCountedUnlessTheyAreLed)
{
    KeptRun run;
    run.state.fabric.x[7] = {0.05, 1.0, 0.0};
    EXPECT_EQ(run.told(), "1 vertices inside of solids, up to 0.05 cm ");
    run.state.fabric.x[7] = {-1.0, 2.0, 3.0};
    EXPECT_EQ(run.told(), "1 vertices outside of the vessel ");
    run.state.fabric.x[0] = {0.05, 1.0, 0.0};
    run.state.fabric.x[7] = {-1.0, 2.0, 0.0};
    EXPECT_EQ(run.told(), "") << "a pin has led it there";
}

TEST(Escapes, FabricThatBeganInASolidOrFeelsNoneIsNotCounted)
{
    std::string scene = kScene;
    scene.replace(scene.find("center: [-1, 2, 0]"), 18, "center: [-1, -1, 0]");
    KeptRun within(scene);
    EXPECT_EQ(within.told(), "");
    KeptRun unfelt(std::string(kScene) + "fabric: {contact: false}\n");
    unfelt.state.fabric.x[7] = {0.05, 1.0, 0.0};
    EXPECT_EQ(unfelt.told(), "");
}

/// Pins go through solids where they are led, and the fabric on them drips there: that has not passed through anything. Beside fabric that they
/// hold in the vessel it has.
TEST(Escapes, WhatLedFabricDripsBehindASolidIsNotCounted)
{
    KeptRun run;
    run.place(5, {2.5, 1.0, 0.0});
    run.state.fabric.x[0] = {-1.0, 2.0, 2.5};
    EXPECT_EQ(run.told(), "");
    run.state.fabric.x[0] = {0.05, 1.0, 0.0};
    EXPECT_EQ(run.told(), "");
    run.state.fabric.x[0] = {-1.0, 2.0, 1.5};
    EXPECT_EQ(run.told(), "1 particles outside of the vessel ");
}

/// A state that is not finite is nowhere.
TEST(Escapes, NonFinitePositionsCountAsEscaped)
{
    KeptRun run;
    run.place(0, sim::Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_NE(run.told(), "");
}

}  // namespace
}  // namespace app
