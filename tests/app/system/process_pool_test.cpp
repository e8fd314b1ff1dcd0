#include "app/system/process_pool.h"

#include <gtest/gtest.h>

#include <map>

namespace app {
namespace {

ProcessPool shells(std::size_t count, int width) { return {.program = *findProgram("sh"), .count = count, .width = width, .limitSeconds = 2.0}; }

TEST(ProcessPool, EachRunsOnceAndTooLongOnesAreEnded)
{
    std::map<std::size_t, ProcessEnd> ends;
    ProcessPool pool = shells(4, 2);
    pool.arguments = [](std::size_t n) { return std::vector<std::string>{"-c", n == 1 ? "exec sleep 30" : "exit 3"}; };
    pool.ended = [&](std::size_t n, const ProcessEnd& end) { EXPECT_TRUE(ends.emplace(n, end).second); };
    runProcesses(pool);
    ASSERT_EQ(ends.size(), 4u);
    for (const auto& [n, end] : ends) {
        EXPECT_EQ(end.timedOut, n == 1);
        EXPECT_EQ(end.exit.code == 3, n != 1);
    }
}

TEST(ProcessPool, NoneIsStartedOnceAStopIsWanted)
{
    int ended = 0;
    ProcessPool pool = shells(10, 1);
    pool.arguments = [](std::size_t) { return std::vector<std::string>{"-c", ":"}; };
    pool.ended = [&](std::size_t, const ProcessEnd&) { ++ended; };
    pool.stopWanted = [&] { return ended == 2; };
    runProcesses(pool);
    EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace app
