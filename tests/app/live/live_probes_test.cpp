#include "tests/app/live/live_drop.h"

#include <gtest/gtest.h>

namespace app::test {
namespace {

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

}  // namespace
}  // namespace app::test
