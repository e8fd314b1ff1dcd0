#include "sim/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace sim {
namespace {

TEST(CounterRandom, GivesTheSameNumberForTheSameKeyAndAnotherForAnother)
{
    const CounterRandom random(1, 2, 3);
    EXPECT_EQ(random.bits(4, 5), CounterRandom(1, 2, 3).bits(4, 5));
    const std::set<std::uint64_t> others = {random.bits(4, 5),
                                            random.bits(5, 4),
                                            random.bits(4, 6),
                                            CounterRandom(2, 1, 3).bits(4, 5),
                                            CounterRandom(1, 3, 2).bits(4, 5),
                                            CounterRandom(1, 2, 4).bits(4, 5)};
    EXPECT_EQ(others.size(), 6u);
}

TEST(CounterRandom, IsUniformAlongIndicesAndDraws)
{
    constexpr int kCount = 100000;
    const CounterRandom random(7, 0);
    double byIndex = 0.0, byDraw = 0.0, square = 0.0, neighbours = 0.0;
    for (int n = 0; n < kCount; ++n) {
        const double u = random.uniform(n);
        EXPECT_TRUE(u >= 0.0 && u < 1.0);
        byIndex += u;
        byDraw += random.uniform(0, n);
        square += u * u;
        neighbours += u * random.uniform(n + 1);
    }
    EXPECT_NEAR(byIndex / kCount, 0.5, 0.005);
    EXPECT_NEAR(byDraw / kCount, 0.5, 0.005);
    EXPECT_NEAR(square / kCount, 1.0 / 3.0, 0.005);
    EXPECT_NEAR(neighbours / kCount, 0.25, 0.005);
}

TEST(CounterRandom, PlacesHaveNumbersOfTheirOwn)
{
    std::set<std::uint64_t> seen;
    for (int i : {-1048576, -1, 0, 1, 1048575})
        for (int j : {-1048576, -1, 0, 1, 1048575})
            for (int k : {-1048576, -1, 0, 1, 1048575}) seen.insert(CounterRandom::placeIndex(i, j, k));
    EXPECT_EQ(seen.size(), 125u);
}

}  // namespace
}  // namespace sim
