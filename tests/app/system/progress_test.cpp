#include "app/system/progress.h"
#include "app/system/statistics.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using test::TemporaryFolder;

TEST(Progress, LineHasFrameTimeStepAndEta)
{
    const ProgressState state = {.frame = 37, .frames = 240, .time = 0.62, .dt = 1.9e-4, .secondsPerStep = 0.031, .secondsLeft = 372.0};
    EXPECT_EQ(progressLine(state), "frame 37/240 · t 0.62 s · dt 1.9e-4 · 0.031 s/step · ETA 6 m 12 s");
    ProgressState oneOfMany = state;
    oneOfMany.allSecondsLeft = 1205.0;
    EXPECT_EQ(progressLine(oneOfMany), progressLine(state) + ", with those to follow 20 m 05 s");
}

TEST(Progress, EtaIsTheRestAtThePaceSoFar)
{
    EXPECT_DOUBLE_EQ(secondsLeft(0.0, 0.25, 1.0, 60.0), 180.0);
    EXPECT_DOUBLE_EQ(secondsLeft(2.0, 2.5, 3.0, 10.0), 10.0);
    EXPECT_DOUBLE_EQ(secondsLeft(0.0, 1.0, 1.0, 60.0), 0.0);
    EXPECT_LT(secondsLeft(0.0, 0.0, 1.0, 5.0), 0.0) << "unknown before the first step";
}

TEST(Progress, DurationsReadLikeDurations)
{
    EXPECT_EQ(formatDuration(0.4), "0 s");
    EXPECT_EQ(formatDuration(59.6), "1 m 00 s");
    EXPECT_EQ(formatDuration(372.0), "6 m 12 s");
    EXPECT_EQ(formatDuration(3780.0), "1 h 03 m");
}

TEST(Progress, ElsewhereThanOnATerminalLinesEnd)
{
    TemporaryFolder folder;
    std::FILE* out = std::fopen((folder / "log").c_str(), "w");
    {
        Progress progress(out, "APIC", 0.0, 1.0, 10);
        progress.stepDone(0.5, 0.01, 0.2);
        progress.frameDone();
        progress.show();
    }
    std::fclose(out);
    const auto lines = test::linesOf(folder / "log");
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].starts_with("APIC  frame 1/10 · t 0.5 s · dt 1.0e-2 · 0.200 s/step · ETA ")) << lines[0];
}

/// Half of it is done: two more take as long as this one, of which as much is left as is done.
TEST(Progress, RunsToFollowCountAsThisOne)
{
    TemporaryFolder folder;
    std::FILE* out = std::fopen((folder / "log").c_str(), "w");
    {
        Progress progress(out, "", 0.0, 1.0, 10);
        progress.setRunsToFollow(2);
        progress.show();
        progress.stepDone(0.5, 0.01, 0.2);
        progress.show();
    }
    std::fclose(out);
    const auto lines = test::linesOf(folder / "log");
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_TRUE(lines[0].ends_with("ETA ?")) << "unknown before the first step: " << lines[0];
    EXPECT_NE(lines[1].find(", with those to follow "), std::string::npos) << lines[1];
}

TEST(Statistics, MedianIsTheMiddle)
{
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({3.0}), 3.0);
    EXPECT_EQ(median({9.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 9.0}), 3.0);
}

}  // namespace
}  // namespace app
