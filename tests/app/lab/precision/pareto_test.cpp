#include "app/lab/precision/pareto.h"

#include <gtest/gtest.h>

#include <cmath>

namespace app {
namespace {

TEST(ParetoFront, HoldsNoneThatAnotherBeats)
{
    const std::vector<Cost> front = paretoFront({{4, 0.1}, {1, 0.8}, {2, 0.9}, {2, 0.4}, {4, 0.05}, {8, 0.06}});
    ASSERT_EQ(front.size(), 3u);
    EXPECT_EQ(front[0].seconds, 1.0);
    EXPECT_EQ(front[1].error, 0.4);
    EXPECT_EQ(front[2].error, 0.05);
}

TEST(ParetoFront, LeavesOutWhatHasNoLogarithm)
{
    const double none = std::nan("");
    EXPECT_TRUE(paretoFront({{1, none}, {none, 1}, {1, 0}, {0, 1}, {1, INFINITY}}).empty());
}

TEST(ParetoFront, TimeGoesByPowersBetweenItsPoints)
{
    const std::vector<Cost> front = {{1, 1.0}, {10, 0.01}};
    EXPECT_NEAR(*secondsAt(front, 0.1), std::sqrt(10.0), 1.0e-12);
    EXPECT_NEAR(*secondsAt(front, 0.01), 10.0, 1.0e-12);
}

TEST(ParetoFront, NothingIsGuessedBeyondItsEnds)
{
    const std::vector<Cost> front = {{2, 1.0}, {10, 0.01}};
    EXPECT_EQ(secondsAt(front, 5.0), 2.0);
    EXPECT_FALSE(secondsAt(front, 0.009));
    EXPECT_FALSE(secondsAt({}, 1.0));
}

}  // namespace
}  // namespace app
