// Mean, spread, and the interval of a difference.
#include "app/ensemble/welch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace app::test {
namespace {

TEST(Welch, QuantilesAreThoseOfTheTables)
{
    // Degrees of freedom, probability on both sides together, t.
    constexpr std::array<std::array<double, 3>, 6> kTable = {{{1.0, 0.5, 1.0},
                                                              {1.0, 0.05, 12.7062047},
                                                              {4.0, 0.001, 8.6103018},
                                                              {10.0, 0.05, 2.2281389},
                                                              {38.0, 0.01, 2.7115576},
                                                              {1.0e6, 0.05, 1.9599664}}};
    for (const auto& [degrees, tail, t] : kTable) EXPECT_NEAR(studentQuantile(tail, degrees), t, 1.0e-6 * t) << degrees;
    // With two degrees t = (1 - p) sqrt(2 / (p (2 - p))).
    for (const double p : {0.9, 0.1, 1.0e-4, 1.0e-9})
        EXPECT_NEAR(studentQuantile(p, 2.0) / ((1.0 - p) * std::sqrt(2.0 / (p * (2.0 - p)))), 1.0, 1.0e-9);
}

TEST(Welch, MeansAreToldAsFarAsTheirDeviationsGo)
{
    const auto text = [](double mean, double deviation) { return textOf({.count = 5, .mean = mean, .deviation = deviation}); };
    EXPECT_EQ(text(879.968, 151.3), "880 ± 150");
    EXPECT_EQ(text(13746.9, 432.1), "13750 ± 430");
    EXPECT_EQ(text(0.349793, 0.0084), "0.3498 ± 0.0084");
    EXPECT_EQ(text(-10730.96, 0.2215), "-10730.96 ± 0.22");
    EXPECT_EQ(text(7.0, 0.0), "7 ± 0");
    EXPECT_EQ(text(3.21e12, 4.5e9), "3.21e+12 ± 4.5e+09");
    EXPECT_EQ(text(2.5e-9, 1.3e-10), "2.5e-09 ± 1.3e-10");
}

TEST(Welch, SpreadLeavesOutWhatIsNoNumber)
{
    const std::array<double, 5> numbers = {1.0, std::numeric_limits<double>::quiet_NaN(), 2.0, 6.0, std::numeric_limits<double>::infinity()};
    const Spread spread = spreadOf(numbers);
    EXPECT_EQ(spread.count, 3u);
    EXPECT_DOUBLE_EQ(spread.mean, 3.0);
    EXPECT_DOUBLE_EQ(spread.variance(), 7.0);
    EXPECT_EQ(spread.lowest, 1.0);
    EXPECT_EQ(spread.highest, 6.0);
    EXPECT_NEAR(spread.marginOfMean(0.95), 4.3026527 * std::sqrt(7.0 / 3.0), 1.0e-6);
    EXPECT_EQ(spreadOf(std::array{0.1, 0.1, 0.1}).deviation, 0.0) << "no rounding makes a spread";
    EXPECT_TRUE(std::isinf(spreadOf(std::array{7.0}).marginOfMean(0.95))) << "one number tells of no spread";
}

TEST(Welch, TheDifferenceHasItsInterval)
{
    // Variances of means 0.5 and 2, four degrees of freedom.
    const Spread a = spreadOf(std::array{1.0, 2.0, 3.0, 4.0, 5.0}), b = spreadOf(std::array{2.0, 4.0, 6.0, 8.0, 10.0});
    const MeanDifference found = welchDifference(a, b, 0.95);
    EXPECT_DOUBLE_EQ(found.difference, 3.0);
    EXPECT_NEAR(found.margin, 2.7764451 * std::sqrt(2.5), 1.0e-6);
    EXPECT_FALSE(found.isSeen());
    EXPECT_TRUE(welchDifference(a, b, 0.85).isSeen());
    EXPECT_FALSE(welchDifference(a, spreadOf(std::array{1000.0}), 0.95).isSeen()) << "one number tells nothing";
}

TEST(Welch, WithoutSpreadItTakesEnoughRuns)
{
    // Chance alone sorts five and five so once in 126 times, four and four once in 35 times.
    const auto difference = [](std::size_t runs, double confidence) {
        const std::vector<double> a(runs, 1.0), b(runs, 1.5);
        return welchDifference(spreadOf(a), spreadOf(b), confidence);
    };
    EXPECT_TRUE(difference(5, 0.99).isSeen());
    EXPECT_EQ(difference(5, 0.99).margin, 0.0);
    EXPECT_FALSE(difference(5, 0.993).isSeen());
    EXPECT_FALSE(difference(4, 0.99).isSeen());
    EXPECT_TRUE(difference(20, 1.0 - 1.0e-9).isSeen());
}

TEST(Welch, PairsAreComparedByTheirOwnDifferences)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> a = {1.0, 100.0, 10000.0, none, 7.0}, b = {2.0, 102.0, 10003.0, 5.0, none};
    const MeanDifference found = pairedDifference(a, b, 0.9);
    EXPECT_DOUBLE_EQ(found.difference, 2.0);
    EXPECT_NEAR(found.margin, 2.9199856 / std::sqrt(3.0), 1.0e-6);
    EXPECT_TRUE(found.isSeen());
    EXPECT_FALSE(welchDifference(spreadOf(a), spreadOf(b), 0.9).isSeen()) << "not among what makes the pairs differ from each other";
    const std::vector<double> same(7, 1.0), more(7, 1.5);
    EXPECT_EQ(pairedDifference(same, same, 0.99).margin, 0.0);
    EXPECT_FALSE(pairedDifference(same, more, 0.99).isSeen()) << "seven heads or tails come once in 64 times";
    EXPECT_TRUE(pairedDifference(same, more, 0.98).isSeen());
}

}  // namespace
}  // namespace app::test
