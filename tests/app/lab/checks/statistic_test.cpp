#include "app/lab/checks/statistic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace app {
namespace {

/// value(t) at n + 1 times from 0 to `end`.
template <class Value>
std::vector<Sample> readings(int n, double end, Value&& value)
{
    std::vector<Sample> all;
    for (int i = 0; i <= n; ++i) all.push_back({end * i / n, value(end * i / n), 2.0});
    return all;
}

TEST(Statistic, OneOfTheReadingsOrTheirMean)
{
    const std::vector<Sample> all = {{0, 3, 0}, {1, 1, 0}, {2, 5, 0}, {3, 4, 0}};
    EXPECT_EQ(statisticOf(Statistic::First, all), 3.0);
    EXPECT_EQ(statisticOf(Statistic::Last, all), 4.0);
    EXPECT_EQ(statisticOf(Statistic::Mean, all), 3.25);
    EXPECT_EQ(statisticOf(Statistic::Smallest, all), 1.0);
    EXPECT_EQ(statisticOf(Statistic::Largest, all), 5.0);
    EXPECT_EQ(statisticOf(Statistic::Change, all), 1.0);
    EXPECT_EQ(statisticOf(Statistic::Reach, all, 4.0), 1.75);
}

TEST(Statistic, SlopesOfLinesPowersAndDecays)
{
    EXPECT_NEAR(statisticOf(Statistic::Slope, readings(20, 2.0, [](double t) { return 7.0 - 3.0 * t; })), -3.0, 1.0e-12);
    EXPECT_NEAR(statisticOf(Statistic::Exponent, readings(20, 2.0, [](double t) { return 4.0 * std::sqrt(t); })), 0.5, 1.0e-12);
    EXPECT_NEAR(statisticOf(Statistic::Rate, readings(20, 2.0, [](double t) { return 4.0 * std::exp(-1.5 * t); })), 1.5, 1.0e-12);
}

TEST(Statistic, PeriodAndEnvelopeOfADampedSwing)
{
    constexpr double kPeriod = 0.7, kRate = 0.1;
    // Whole periods, else their mean is not what they swing about; damping shifts it by as little as the figures say.
    const auto all =
        readings(4000, 10.0 * kPeriod, [](double t) { return 5.0 + std::exp(-kRate * t) * std::sin(2.0 * std::numbers::pi * t / kPeriod); });
    EXPECT_NEAR(statisticOf(Statistic::Period, all), kPeriod, 1.0e-3 * kPeriod);
    EXPECT_NEAR(statisticOf(Statistic::EnvelopeRate, all), kRate, 0.02 * kRate);
}

TEST(Statistic, ErrorsAreRelativeToWhatIsKnown)
{
    const std::vector<Sample> all = {{0, 1.0, 2.0}, {1, 2.2, 2.0}};
    EXPECT_NEAR(statisticOf(Statistic::MeanError, all), 0.3, 1.0e-12);
    EXPECT_NEAR(statisticOf(Statistic::LargestError, all), 0.5, 1.0e-12);
}

TEST(Statistic, RmsErrorIsRelativeToTheWayOfWhatIsKnown)
{
    // What is known goes from 2 to 5 and 6: 3 and 4 away from where it began.
    const std::vector<Sample> all = {{0, 2.0, 2.0}, {1, 5.0, 5.0}, {2, 8.0, 6.0}};
    EXPECT_NEAR(statisticOf(Statistic::RmsError, all), 2.0 / 5.0, 1.0e-12);
}

TEST(Statistic, RmsDifferenceIsThatOfWhatIsReadAndKnown)
{
    const std::vector<Sample> all = {{0, 2.0, 2.0}, {1, 5.0, 8.0}, {2, 8.0, 4.0}};
    EXPECT_NEAR(statisticOf(Statistic::RmsDifference, all), 5.0 / std::sqrt(3.0), 1.0e-12);
}

TEST(Statistic, ShareInsideCountsReadingsInTheBandWithItsEnds)
{
    const std::vector<Sample> all = {{0, 1.0, 1.5, 1.0, 2.0}, {1, 2.1, 1.5, 1.0, 2.0}, {2, 2.9, 3.0, 2.8, 3.1}, {3, 2.7, 3.0, 2.8, 3.1}};
    EXPECT_EQ(statisticOf(Statistic::ShareInside, all), 0.5);
    const std::vector<Sample> withoutBand = {{0, 1.0, 1.0}};
    EXPECT_EQ(statisticOf(Statistic::ShareInside, withoutBand), 0.0);
}

TEST(Statistic, PlacesOfExtremesAreThoseOfTheFirst)
{
    const std::vector<Sample> all = {{0.0, 3, 0}, {0.5, 1, 0}, {1.0, 5, 0}, {1.5, 1, 0}, {2.0, 5, 0}};
    EXPECT_EQ(statisticOf(Statistic::SmallestAt, all), 0.5);
    EXPECT_EQ(statisticOf(Statistic::LargestAt, all), 1.0);
}

TEST(Statistic, IsNotANumberWhereThereAreTooFewReadings)
{
    EXPECT_TRUE(std::isnan(statisticOf(Statistic::Last, {})));
    const std::vector<Sample> one = {{1, 1, 1}}, rising = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    EXPECT_TRUE(std::isnan(statisticOf(Statistic::Slope, one)));
    EXPECT_TRUE(std::isnan(statisticOf(Statistic::Period, rising)));
    EXPECT_TRUE(std::isnan(statisticOf(Statistic::EnvelopeRate, rising)));
    EXPECT_TRUE(std::isnan(statisticOf(Statistic::Reach, rising, 3.0)));
}

}  // namespace
}  // namespace app
