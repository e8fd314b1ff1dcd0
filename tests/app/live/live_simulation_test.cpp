#include "app/live/live_simulation.h"

#include "tests/app/fake_backends.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace app::test {
namespace {

/// Long enough for any machine; a test that waits for what never comes fails then.
constexpr auto kPatience = std::chrono::seconds(30);

template <class F>
bool comesTrue(F&& isTrue)
{
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!isTrue()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

/// A toy of 0.05 s in steps of 4 ms, cut at frames of 0.01 s: 15 steps.
struct Live {
    ToySettings toy;
    LiveSimulation live;

    explicit Live(const ToySettings& t = {}, std::size_t memory = std::size_t{1} << 20) : toy(t), live(SceneRequest(), toyBackends(t), memory) {}
    bool comesTo(LiveMode mode)
    {
        return comesTrue([&] { return live.status().mode == mode; });
    }
    bool comesToStep(std::int64_t step)
    {
        return comesTrue([&] { return live.status().step == step && live.status().mode == LiveMode::Paused; });
    }
    /// Place of the particle in the picture that waits [cm]; NaN if none does.
    double seen()
    {
        const auto snapshot = live.takeSnapshot();
        return snapshot ? snapshot->positions.at(0).x() : std::nan("");
    }
};

TEST(LiveSimulation, BeginsPausedWithTheInitialState)
{
    Live l;
    EXPECT_EQ(l.live.status().mode, LiveMode::Paused);
    EXPECT_EQ(l.live.status().step, 0);
    EXPECT_EQ(l.live.status().moments, std::vector<double>{0.0});
    EXPECT_EQ(l.seen(), 0.0);
    EXPECT_EQ(l.live.takeSnapshot(), nullptr) << "a picture is handed out once";
}

TEST(LiveSimulation, PlaysToTheEndInTheStepsOfARun)
{
    Live l;
    l.live.play();
    ASSERT_TRUE(l.comesTo(LiveMode::Ended));
    const auto steps = l.live.takeSteps();
    ASSERT_EQ(steps.size(), 15u);
    for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_NEAR(steps[i].report.dt, i % 3 == 2 ? 0.002 : 0.004, 1.0e-12) << i;
    EXPECT_EQ(l.live.status().time, 0.05);
    EXPECT_NEAR(l.seen(), 0.05, 1.0e-6) << "the last state is shown";
    l.live.play();
    l.live.stepOnce();
    l.live.pause();
    EXPECT_TRUE(comesTrue([&] { return l.live.status().mode == LiveMode::Ended; }));
    EXPECT_TRUE(l.live.takeSteps().empty());
}

TEST(LiveSimulation, StepsOneByOne)
{
    Live l;
    l.live.stepOnce();
    l.live.stepOnce();
    ASSERT_TRUE(l.comesToStep(2));
    EXPECT_NEAR(l.seen(), 0.008, 1.0e-6);
}

TEST(LiveSimulation, PausesBetweenTwoSteps)
{
    ToySettings toy;
    toy.duration = 1000.0;
    toy.stepMilliseconds = 1;
    Live l(toy);
    l.live.play();
    ASSERT_TRUE(comesTrue([&] { return l.live.status().step > 5; }));
    l.live.pause();
    ASSERT_TRUE(l.comesTo(LiveMode::Paused));
    // What is shown is whole: the particle is where it is at the time of the picture.
    const auto snapshot = l.live.takeSnapshot();
    ASSERT_TRUE(snapshot);
    EXPECT_NEAR(snapshot->positions.at(0).x(), snapshot->time, 1.0e-5);
    EXPECT_EQ(snapshot->time, l.live.status().time);
}

TEST(LiveSimulation, ShowsWholeStatesWhileItRuns)
{
    ToySettings toy;
    toy.duration = 1000.0;
    Live l(toy);
    l.live.play();
    std::unique_ptr<FrameSnapshot> shown;
    double last = -1.0;
    for (int pictures = 0; pictures < 50;) {
        shown = l.live.takeSnapshot(std::move(shown));
        ASSERT_TRUE(shown);
        ASSERT_NEAR(shown->positions.at(0).x(), shown->time, 1.0e-6 * (1.0 + shown->time));
        ASSERT_GE(shown->time, last);
        if (shown->time > last) ++pictures;
        last = shown->time;
    }
}

TEST(LiveSimulation, GoesBackAndOnAsBefore)
{
    Live l;
    l.live.play();
    ASSERT_TRUE(l.comesTo(LiveMode::Ended));
    EXPECT_EQ(l.live.status().moments.size(), 5u) << "the start and every frame but the last";
    l.live.goBackTo(0.025);
    ASSERT_TRUE(l.comesTo(LiveMode::Paused));
    EXPECT_NEAR(l.live.status().time, 0.02, 1.0e-12);
    EXPECT_EQ(l.live.status().step, 6);
    EXPECT_EQ(l.live.status().moments.size(), 3u) << "what came after it has not happened";
    EXPECT_NEAR(l.seen(), 0.02, 1.0e-6);
    l.live.play();
    ASSERT_TRUE(l.comesTo(LiveMode::Ended));
    EXPECT_EQ(l.live.status().step, 15);
    EXPECT_NEAR(l.seen(), 0.05, 1.0e-6);

    l.live.restart();
    ASSERT_TRUE(l.comesToStep(0));
    EXPECT_EQ(l.live.status().moments, std::vector<double>{0.0});
}

TEST(LiveSimulation, KeepsFewerMomentsInLessMemory)
{
    ToySettings toy;
    toy.duration = 1.0;
    toy.every = toy.dt;
    constexpr std::size_t kOfOne = 6 * sizeof(double);  // position, velocity's mean, mass and number
    Live l(toy, 8 * kOfOne);
    l.live.play();
    ASSERT_TRUE(l.comesTo(LiveMode::Ended));
    const std::vector<double> moments = l.live.status().moments;
    EXPECT_LE(moments.size(), 8u);
    EXPECT_GE(moments.size(), 4u);
    EXPECT_EQ(moments.front(), 0.0);
    for (std::size_t i = 2; i < moments.size(); ++i) EXPECT_NEAR(moments[i] - moments[i - 1], moments[1], 1.0e-9) << "evenly";
    EXPECT_GT(moments.back(), 0.5);
}

TEST(LiveSimulation, TellsWhyItFailedAndCanGoBack)
{
    ToySettings toy;
    toy.failAtStep = 3;
    Live l(toy);
    l.live.play();
    ASSERT_TRUE(l.comesTo(LiveMode::Failed));
    EXPECT_NE(l.live.status().failure.find("the toy fell over"), std::string::npos) << l.live.status().failure;
    l.live.restart();
    ASSERT_TRUE(l.comesToStep(0));
    EXPECT_EQ(l.live.status().failure, "");
}

/// What is wanted anew comes at once, while it is paused too, and stays.
TEST(LiveSimulation, ShowsWhatIsAskedFor)
{
    Live l;
    ASSERT_TRUE(l.live.takeSnapshot()->lines.empty());
    l.live.show({.arrows = true, .arrowTime = 2.0});
    std::unique_ptr<FrameSnapshot> shown;
    ASSERT_TRUE(comesTrue([&] { return (shown = l.live.takeSnapshot()) != nullptr; }));
    EXPECT_EQ(l.live.status().step, 0);
    ASSERT_EQ(shown->lines.size(), 2u);
    EXPECT_FLOAT_EQ(shown->lines[1].points.at(1).x(), 2.0f) << "1 cm/s for 2 s";
    EXPECT_TRUE(shown->extras.arrows);
    l.live.stepOnce();
    ASSERT_TRUE(l.comesToStep(1));
    EXPECT_EQ(l.live.takeSnapshot()->lines.size(), 2u);
}

TEST(LiveSimulation, EndsAmidAStep)
{
    ToySettings toy;
    toy.duration = 1000.0;
    toy.stepMilliseconds = 20;
    Live l(toy);
    l.live.play();
    ASSERT_TRUE(comesTrue([&] { return l.live.status().step > 0; }));
    l.live.goBackTo(0.0);  // asked for and never done, or done: both end well
}

}  // namespace
}  // namespace app::test
