#include "app/live/live_pair.h"

#include "tests/app/fake_backends.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace app::test {
namespace {

/// Two toys of 0.1 s in ten frames, one of which takes its steps much faster.
struct Pair {
    LivePair pair;

    static Backends backends(int stepMilliseconds, int failAtStep = 0)
    {
        ToySettings toy;
        toy.duration = 0.1;
        toy.dt = stepMilliseconds > 1 ? 0.004 : 0.002;
        toy.stepMilliseconds = stepMilliseconds;
        toy.failAtStep = failAtStep;
        return toyBackends(toy);
    }
    explicit Pair(int failAtStep = 0) : pair({}, backends(1)) { pair.addSecondSide({}, backends(7, failAtStep)); }

    double time(int side) const
    {
        const auto& shown = pair.sides()[side]->shown;
        return shown ? shown->time : -1.0;
    }
    template <class F>
    bool comesTrue(F&& isTrue)
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (!isTrue()) {
            if (std::chrono::steady_clock::now() > end) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            pair.takeNewest();
        }
        return true;
    }
    bool isSettled()
    {
        for (const auto& side : pair.sides())
            if (side->live.status().mode == LiveMode::Playing) return false;
        return time(0) == pair.sides()[0]->live.status().time && time(1) == pair.sides()[1]->live.status().time;
    }
};

TEST(LivePair, PicturesAreOfOneTimeHoweverFastTheirScenesAre)
{
    Pair p;
    ASSERT_TRUE(p.comesTrue([&] { return p.time(0) == 0.0 && p.time(1) == 0.0; }));
    p.pair.playOrPause();
    int pictures = 0;
    double last = 0.0;
    ASSERT_TRUE(p.comesTrue([&] {
        EXPECT_EQ(p.time(0), p.time(1));
        if (p.time(0) != last) ++pictures;
        last = p.time(0);
        return p.time(0) >= 0.1;
    }));
    EXPECT_EQ(pictures, 10) << "none is passed over";
}

TEST(LivePair, PausesBothAtOneTime)
{
    for (int repeat = 0; repeat < 5; ++repeat) {
        Pair p;
        p.pair.playOrPause();
        ASSERT_TRUE(p.comesTrue([&] { return p.time(0) >= 0.02 && p.time(1) >= 0.02; }));
        p.pair.playOrPause();
        ASSERT_TRUE(p.comesTrue([&] { return p.isSettled() && p.time(0) == p.time(1); }));
        EXPECT_LT(p.time(0), 0.06) << "soon after";
    }
}

TEST(LivePair, StepsAreThoseThatWereAskedFor)
{
    for (int repeat = 0; repeat < 10; ++repeat) {
        Pair p;
        for (int step = 0; step < 3; ++step) p.pair.all([](LiveSimulation& live) { live.stepOnce(); });
        ASSERT_TRUE(p.comesTrue([&] { return p.time(0) >= 0.03 && p.time(1) >= 0.03; }));
        p.pair.playOrPause();
        ASSERT_TRUE(p.comesTrue([&] {
            EXPECT_EQ(p.time(0), p.time(1));
            return p.time(0) >= 0.1;
        }));
    }
}

TEST(LivePair, GoesBackAndRestartsTogether)
{
    Pair p;
    p.pair.playOrPause();
    ASSERT_TRUE(p.comesTrue([&] { return p.time(0) >= 0.1 && p.time(1) >= 0.1; }));
    p.pair.all([](LiveSimulation& live) { live.goBackTo(0.055); });
    ASSERT_TRUE(p.comesTrue([&] { return p.isSettled() && p.time(0) == p.time(1) && p.time(0) < 0.1; }));
    EXPECT_NEAR(p.time(0), 0.05, 1.0e-12);
    p.pair.all([](LiveSimulation& live) { live.restart(); });
    ASSERT_TRUE(p.comesTrue([&] { return p.time(0) == 0.0 && p.time(1) == 0.0; }));
}

TEST(LivePair, OneThatFailsDoesNotHoldUpTheOther)
{
    Pair p(9);
    p.pair.playOrPause();
    ASSERT_TRUE(p.comesTrue([&] { return p.time(0) >= 0.1; }));
    EXPECT_EQ(p.pair.sides()[1]->live.status().mode, LiveMode::Failed);
}

TEST(LivePair, AloneItShowsWhatIsNewestOrEveryFrame)
{
    Pair p;
    p.pair.removeSecondSide();
    p.pair.showEveryFrame(true);
    p.pair.playOrPause();
    std::vector<double> times;
    ASSERT_TRUE(p.comesTrue([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (times.empty() || times.back() != p.time(0)) times.push_back(p.time(0));
        return p.time(0) >= 0.1;
    }));
    EXPECT_GE(times.size(), 11u);
}

}  // namespace
}  // namespace app::test
