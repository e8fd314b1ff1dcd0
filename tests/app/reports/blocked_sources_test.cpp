#include "app/reports/blocked_sources.h"

#include "app/lab/validation/run_case.h"
#include "app/runs/run_offline.h"
#include "tests/app/fake_backends.h"
#include "tests/app/log.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

sim::Scene twoSources()
{
    sim::Scene scene;
    scene.sources.resize(2);
    scene.sources[0].name = "tap";
    scene.sources[0].where = "cup.yaml:7";
    scene.sources[1].name = "jet";
    scene.sources[1].where = "cup.yaml:9";
    return scene;
}

TEST(BlockedSources, AreToldOfOnceEachWithTimeAndVolume)
{
    BlockedSources shut(twoSources());
    sim::State state;
    EXPECT_TRUE(shut.newlyBlocked(state).empty()) << "nothing was looked at yet";
    state.time = 1.5;
    state.emittedVolume = {12.25, 3.0};
    state.memory.sources.resize(2);
    EXPECT_TRUE(shut.newlyBlocked(state).empty());
    state.memory.sources[0].isShut = 1.0;
    EXPECT_EQ(shut.newlyBlocked(state),
              std::vector<std::string>{"cup.yaml:7: liquid.sources.tap: stops at 1.5 s after 12.25 cm^3: what it flows into is closed "
                                       "and full; it goes on as soon as there is room"});
    EXPECT_TRUE(shut.newlyBlocked(state).empty());
    state.memory.sources[0].isShut = 0.0;
    EXPECT_TRUE(shut.newlyBlocked(state).empty());
    state.memory.sources[0].isShut = state.memory.sources[1].isShut = 1.0;
    const std::vector<std::string> second = shut.newlyBlocked(state);
    ASSERT_EQ(second.size(), 1u);
    EXPECT_NE(second[0].find("liquid.sources.jet: stops at 1.5 s after 3 cm^3"), std::string::npos) << second[0];
}

LoadedScene setupOf(const test::ToySettings& toy)
{
    LoadedScene setup = test::toySetup(toy);
    setup.scene.sources.resize(1);
    setup.scene.sources[0].name = "tap";
    return setup;
}

int timesTold(const std::string& words)
{
    int times = 0;
    for (std::size_t at = 0; (at = words.find("liquid.sources.tap: stops at 0.012 s after 0.75 cm^3", at)) != std::string::npos; ++at) ++times;
    return times;
}

/// The toy's third step ends at 0.01 s, where a frame is, or 0.012 s.
TEST(BlockedSources, AreToldOfByValidate)
{
    const test::ToySettings toy{.every = 0.05, .shutAtStep = 3};
    LoadedScene setup = setupOf(toy);
    setup.file = sim::sceneFileFromText("drench: 1\nvalidate:\n  every: 0.05\n  checks:\n    - {read: liquid_x, at_most: 9}\n", "case.yaml");
    const test::Log log;
    EXPECT_TRUE(runCase("cup", setup, test::toyBackends(toy), [] { return false; }).passes());
    EXPECT_EQ(timesTold(log.words()), 1) << log.words();
}

TEST(BlockedSources, AreToldOfByRun)
{
    const test::ToySettings toy{.every = 0.05, .shutAtStep = 3};
    const test::TemporaryFolder folder;
    const test::Log log;
    runOffline(setupOf(toy), test::toyBackends(toy), {.out = folder / "out", .contentHash = "0", .stopWanted = [] { return false; }});
    EXPECT_EQ(timesTold(log.words()), 1) << log.words();
}

}  // namespace
}  // namespace app
