// The crew runs the program it is in: here that of the tests, which is told to run one test of its own.

#include "app/lab/child_crew.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <thread>

namespace app {
namespace {

TEST(ChildCrewMember, DISABLED_Sleeps) { std::this_thread::sleep_for(std::chrono::seconds(30)); }
TEST(ChildCrewMember, DISABLED_Ends) {}

std::vector<std::string> toRun(const std::string& member) { return {"--gtest_also_run_disabled_tests", "--gtest_filter=ChildCrewMember.DISABLED_" + member}; }

TEST(ChildCrew, EachRunsOnceAndTooLongOnesAreEnded)
{
    std::map<std::size_t, CrewEnd> ends;
    Crew crew{.count = 4, .width = 2, .limitSeconds = 3.0};
    crew.arguments = [](std::size_t n) { return toRun(n == 1 ? "Sleeps" : "Ends"); };
    crew.ended = [&](std::size_t n, const CrewEnd& end) { EXPECT_TRUE(ends.emplace(n, end).second); };
    runCrew(crew);
    ASSERT_EQ(ends.size(), 4u);
    for (const auto& [n, end] : ends) {
        EXPECT_EQ(end.timedOut, n == 1);
        EXPECT_EQ(end.exit.ok(), n != 1);
    }
}

TEST(ChildCrew, NoneIsStartedOnceAStopIsWanted)
{
    int ended = 0;
    Crew crew{.count = 10, .width = 1};
    crew.arguments = [](std::size_t) { return toRun("Ends"); };
    crew.ended = [&](std::size_t, const CrewEnd&) { ++ended; };
    crew.stopWanted = [&] { return ended == 2; };
    runCrew(crew);
    EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace app
