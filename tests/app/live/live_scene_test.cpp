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

SceneRequest shortDrop()
{
    return {.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml", .variant = "", .sets = {"time.duration=0.02", "output.every=0.005", "time.dt=1.0e-3"}};
}

std::uint64_t hashOfRun(const SceneRequest& request)
{
    const LoadedScene setup = drenchBackends().loadScene(request);
    const auto run = drenchBackends().startSimulation(setup);
    for (std::int64_t frame = 1; frame <= frameCount(setup); ++frame)
        while (run->state().time < frameTime(setup, frame)) run->step(frameTime(setup, frame));
    return run->stateHash();
}

struct LiveDrop {
    LiveSimulation live;

    explicit LiveDrop(const SceneRequest& request = shortDrop()) : live(request, drenchBackends()) {}

    template <class F>
    bool comesTrue(F&& isTrue)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (!isTrue()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return true;
    }
    void steps(int n)
    {
        for (int i = 0; i < n; ++i) live.stepOnce();
        live.stateHash();  // when all that was asked for is done
    }
    void change(std::vector<std::string> sets)
    {
        live.change(std::move(sets));
        live.stateHash();
    }
    std::uint64_t end()
    {
        live.play();
        EXPECT_TRUE(comesTrue([&] { return live.status().mode == LiveMode::Ended; }));
        return live.stateHash();
    }
    /// The next one: none waits while another is being made.
    std::unique_ptr<FrameSnapshot> snapshot()
    {
        std::unique_ptr<FrameSnapshot> taken;
        EXPECT_TRUE(comesTrue([&] { return (taken = live.takeSnapshot()) != nullptr; }));
        return taken;
    }
    std::string valueOf(const std::string& path) const
    {
        const auto scene = live.scene();
        const auto found = std::ranges::find(scene->parameters, path, &sim::Parameter::path);
        return found == scene->parameters.end() ? "" : found->value;
    }
    /// Its scene in a file, as somebody would send it to a machine without a display.
    std::uint64_t hashOfSaved() const
    {
        const TemporaryFolder folder;
        writeWhole(folder / "saved.yaml", live.scene()->setup.resolved);
        return hashOfRun({.file = (folder / "saved.yaml").string(), .variant = "", .sets = {}});
    }
};

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

/// The drop with readings of all kinds, one of them without a value.
SceneRequest probedDrop()
{
    SceneRequest request = shortDrop();
    request.sets.emplace_back(
        "output.probes={every: 2.0e-3, readings: [{name: height, unit: cm, read: liquid_y}, {read: energy}, {name: nowhere, read: 1/(t-t)},"
        " {name: pressure, unit: dyn/cm^2, read: \"pressure(x, y, z)\", along: {from: [0, 0, 0], to: [0, 1, 0], points: 3}}]}");
    return request;
}

/// Of a run without a window.
std::vector<ProbeReading> readingsOfRun(const SceneRequest& request)
{
    const LoadedScene setup = drenchBackends().loadScene(request);
    const auto run = drenchBackends().startSimulation(setup);
    ProbeReader reader(*readProbes(setup), setup.scene.settings.time.start);
    std::vector<ProbeReading> readings = {reader.initial(*run)};
    for (std::int64_t frame = 1; frame <= frameCount(setup); ++frame)
        while (run->state().time < frameTime(setup, frame)) {
            const bool isReflected = run->step(frameTime(setup, frame)).isReflected;
            if (const auto reading = reader.step(*run, isReflected)) readings.push_back(*reading);
        }
    return readings;
}

void expectSame(std::span<const ProbeReading> seen, std::span<const ProbeReading> known)
{
    ASSERT_EQ(seen.size(), known.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i].time, known[i].time);
        EXPECT_EQ(seen[i].values, known[i].values) << "at " << known[i].time << " s";
    }
}

TEST(LiveScene, ProbesReadWhatThoseOfARunDoAndChangeNothing)
{
    LiveDrop drop(probedDrop());
    EXPECT_EQ(drop.end(), hashOfRun(shortDrop()));
    const LiveReadings taken = drop.live.takeReadings();
    ASSERT_TRUE(taken.titles);
    ASSERT_EQ(taken.titles->size(), 4u);
    EXPECT_EQ(taken.titles->front().name, "height");
    EXPECT_EQ(taken.titles->front().unit, "cm");
    EXPECT_EQ(taken.titles->back().points, 3u);
    const std::vector<ProbeReading> known = readingsOfRun(probedDrop());
    ASSERT_GE(known.size(), 9u);
    EXPECT_EQ(known.back().values.size(), 6u);
    EXPECT_FALSE(known.back().values[2]);
    expectSame(taken.readings, known);
    EXPECT_TRUE(drop.live.takeReadings().readings.empty()) << "they are handed out once";
}

TEST(LiveScene, ReadingsAfterATimeAreForgottenAndReadAgain)
{
    const std::vector<ProbeReading> known = readingsOfRun(probedDrop());
    const auto after = std::ranges::find_if(known, [](const ProbeReading& reading) { return reading.time > 0.01; });
    LiveDrop drop(probedDrop());
    drop.end();
    drop.live.takeReadings();
    drop.live.goBackTo(0.011);
    drop.live.stateHash();  // when it is there
    drop.end();
    const LiveReadings again = drop.live.takeReadings();
    EXPECT_EQ(again.dropAfter, 0.01);
    expectSame(again.readings, {after, known.end()});
    drop.live.restart();
    drop.live.stateHash();
    drop.end();
    const LiveReadings anew = drop.live.takeReadings();
    EXPECT_LT(anew.dropAfter, 0.0);
    expectSame(anew.readings, known);
}

TEST(LiveScene, WithoutProbesNothingIsRead)
{
    LiveDrop drop;
    drop.steps(3);
    const LiveReadings taken = drop.live.takeReadings();
    EXPECT_FALSE(taken.titles);
    EXPECT_TRUE(taken.readings.empty());
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
