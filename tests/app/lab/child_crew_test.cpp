#include "app/lab/child_crew.h"

#include <gtest/gtest.h>

#include <map>

namespace app {
namespace {

Crew shells(std::size_t count, int width)
{
    return {.program = *findProgram("sh"), .count = count, .width = width, .limitSeconds = 2.0};
}

TEST(ChildCrew, EachRunsOnceAndTooLongOnesAreEnded)
{
    std::map<std::size_t, CrewEnd> ends;
    Crew crew = shells(4, 2);
    crew.arguments = [](std::size_t n) { return std::vector<std::string>{"-c", n == 1 ? "exec sleep 30" : "exit 3"}; };
    crew.ended = [&](std::size_t n, const CrewEnd& end) { EXPECT_TRUE(ends.emplace(n, end).second); };
    runCrew(crew);
    ASSERT_EQ(ends.size(), 4u);
    for (const auto& [n, end] : ends) {
        EXPECT_EQ(end.timedOut, n == 1);
        EXPECT_EQ(end.exit.code == 3, n != 1);
    }
}

TEST(ChildCrew, NoneIsStartedOnceAStopIsWanted)
{
    int ended = 0;
    Crew crew = shells(10, 1);
    crew.arguments = [](std::size_t) { return std::vector<std::string>{"-c", ":"}; };
    crew.ended = [&](std::size_t, const CrewEnd&) { ++ended; };
    crew.stopWanted = [&] { return ended == 2; };
    runCrew(crew);
    EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace app
