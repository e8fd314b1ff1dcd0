#include "tests/app/live/live_drop.h"

#include "app/live/live_simulation.h"
#include "app/probes/probe_reader.h"
#include "app/system/atomic_files.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

// Scenes that are simulated live, with settings that change on the way.

namespace app::test {
namespace {

TEST(LiveScene, EndsAsARunDoes)
{
    LiveDrop drop;
    const std::uint64_t known = hashOfRun(shortDrop());
    EXPECT_EQ(drop.end(), known);
    drop.live.goBackTo(0.011);
    EXPECT_TRUE(drop.comesTrue([&] { return drop.live.status().mode == LiveMode::Paused; }));
    EXPECT_EQ(drop.live.status().time, 0.01);
    EXPECT_EQ(drop.end(), known);
}

TEST(LiveScene, WhatWasChangedOnTheWayIsRepeatedByARunOfIt)
{
    LiveDrop drop;
    drop.steps(4);
    drop.change({"time.dt=0.7 ms", "transfer.modes.liquid=27"});
    EXPECT_EQ(drop.live.status().refused, "");
    EXPECT_EQ(drop.valueOf("time.dt"), "0.0007");
    drop.steps(5);
    drop.change({"gravity=[0, 0, 0]"});
    drop.change({"gravity=[100 cm/s^2, -500 cm/s^2, 0]"});
    const std::uint64_t hash = drop.end();
    EXPECT_NE(hash, hashOfRun(shortDrop()));
    EXPECT_EQ(hash, drop.hashOfSaved()) << "as YAML";
    EXPECT_EQ(hash, hashOfRun(drop.live.scene()->request)) << "as a command line";
    EXPECT_EQ(drop.live.scene()->setup.scene.changes.size(), 2u) << "one for each step";
}

TEST(LiveScene, SettingsOfAWholeRunWaitForARestart)
{
    LiveDrop drop;
    drop.steps(3);
    drop.change({"time.dt=5.0e-4"});
    drop.change({"grid.cell=0.3"});
    EXPECT_EQ(drop.live.scene()->waiting, std::vector<std::string>{"grid.cell=0.3"});
    EXPECT_NE(drop.valueOf("grid.cell"), "0.3");
    drop.live.restart();
    drop.live.stateHash();
    EXPECT_EQ(drop.valueOf("grid.cell"), "0.3");
    EXPECT_EQ(drop.live.status().step, 0);
    EXPECT_TRUE(drop.live.scene()->waiting.empty());
    EXPECT_TRUE(drop.live.scene()->setup.scene.changes.empty()) << "what was changed on the way holds from the start";
    SceneRequest same = shortDrop();
    same.sets.insert(same.sets.end(), {"time.dt=5.0e-4", "grid.cell=0.3"});
    EXPECT_EQ(drop.end(), hashOfRun(same));
}

TEST(LiveScene, ARestartTakesTheFileAsItIsNow)
{
    const TemporaryFolder folder;
    SceneRequest request = shortDrop();
    const std::string text = readWhole(request.file), file = (folder / "mine.yaml").string();
    request.file = file;
    writeWhole(file, text);
    LiveDrop drop(request);
    drop.steps(3);
    const auto before = drop.snapshot();
    std::string other = text;
    other.replace(other.find("radius: 0.6"), 11, "radius: 0.3");
    writeWhole(file, other + "changes: [{step: 4, set: {gravity: [0, 0, 0]}}]\n");
    drop.change({"time.dt=1.0e-4"});
    EXPECT_EQ(drop.live.status().refused, file + ": was changed since the start; restart to take it as it is now");
    drop.live.restart();
    drop.live.stateHash();
    const auto after = drop.snapshot();
    ASSERT_TRUE(before && after);
    EXPECT_LT(after->positions.size(), before->positions.size());
    EXPECT_EQ(drop.end(), hashOfRun(request));
    EXPECT_EQ(drop.valueOf("gravity"), "[0, 0, 0]") << "its own changes come with it";
}

TEST(LiveScene, BeforeTheFirstStepEverythingChangesAtOnce)
{
    LiveDrop drop;
    const auto before = drop.snapshot();
    drop.change({"grid.cell=0.3"});
    const auto after = drop.snapshot();
    ASSERT_TRUE(before && after);
    EXPECT_NE(before->positions.size(), after->positions.size());
    EXPECT_EQ(drop.live.status().mode, LiveMode::Paused);
}

TEST(LiveScene, ABranchKeepsTheSettingsAndIsRepeatedByARunOfIt)
{
    LiveDrop drop;
    drop.steps(12);
    drop.change({"gravity=[0, 0, 0]"});
    drop.end();
    drop.live.goBackTo(0.005);
    drop.live.stateHash();
    const std::int64_t step = drop.live.status().step;
    EXPECT_LT(step, 12);
    EXPECT_EQ(drop.valueOf("gravity"), "[0, 0, 0]");
    EXPECT_EQ(drop.end(), drop.hashOfSaved());
    ASSERT_EQ(drop.live.scene()->setup.scene.changes.size(), 1u);
    EXPECT_EQ(drop.live.scene()->setup.scene.changes[0].step, step + 1);
}

TEST(LiveScene, BadValuesAreRefusedWithTheReadersMessage)
{
    LiveDrop drop;
    drop.steps(2);
    drop.change({"time.dt=-1"});
    EXPECT_EQ(drop.live.status().refused, "--set time.dt=-1: time.dt: \"-1\" is out of range; must be above 0 s");
    drop.change({"grid.cell=big"});
    EXPECT_NE(drop.live.status().refused, "");
    EXPECT_TRUE(drop.live.scene()->waiting.empty());
    EXPECT_EQ(drop.end(), hashOfRun(shortDrop())) << "nothing has changed";
    drop.change({"time.dt=1.0e-4"});
    EXPECT_EQ(drop.live.status().refused, "");
}

TEST(LiveScene, FrameByFrameItWaitsUntilAPictureIsTaken)
{
    LiveDrop drop;
    drop.live.frameByFrame(true);
    drop.live.takeSnapshot();
    drop.live.play();
    for (const double time : {0.0, 0.005, 0.01, 0.015, 0.02}) {
        ASSERT_TRUE(drop.comesTrue([&] { return drop.live.waiting() == time; })) << time;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        EXPECT_EQ(drop.live.status().time, time) << "it does not run ahead";
        drop.live.takeSnapshot();
    }
    EXPECT_EQ(drop.live.stateHash(), hashOfRun(shortDrop()));
}

TEST(LiveScene, FrameByFrameStepsAndPausesEndAtFrames)
{
    LiveDrop drop;
    drop.live.frameByFrame(true);
    drop.steps(1);
    EXPECT_EQ(drop.live.status().time, 0.005);
    drop.live.takeSnapshot();
    drop.live.play();
    drop.live.pause();
    ASSERT_TRUE(drop.comesTrue([&] {
        drop.live.takeSnapshot();
        return drop.live.status().mode == LiveMode::Paused;
    }));
    const double frames = drop.live.status().time / 0.005;
    EXPECT_NEAR(frames, std::round(frames), 1.0e-9);
}

}  // namespace
}  // namespace app::test
