#include "app/lab/checks/statistic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace app {
namespace {

/// value(t) at n + 1 times from 0 to `end`.
template <class Value>
std::vector<Reading> readings(int n, double end, Value&& value)
{
    std::vector<Reading> all;
    for (int i = 0; i <= n; ++i) all.push_back({end * i / n, value(end * i / n), 2.0});
    return all;
}

TEST(Take, OneOfTheReadingsOrTheirMean)
{
    const std::vector<Reading> all = {{0, 3, 0}, {1, 1, 0}, {2, 5, 0}, {3, 4, 0}};
    EXPECT_EQ(take(Take::First, all), 3.0);
    EXPECT_EQ(take(Take::Last, all), 4.0);
    EXPECT_EQ(take(Take::Mean, all), 3.25);
    EXPECT_EQ(take(Take::Smallest, all), 1.0);
    EXPECT_EQ(take(Take::Largest, all), 5.0);
    EXPECT_EQ(take(Take::Change, all), 1.0);
    EXPECT_EQ(take(Take::Reach, all, 4.0), 1.75);
}

TEST(Take, SlopesOfLinesPowersAndDecays)
{
    EXPECT_NEAR(take(Take::Slope, readings(20, 2.0, [](double t) { return 7.0 - 3.0 * t; })), -3.0, 1.0e-12);
    EXPECT_NEAR(take(Take::Exponent, readings(20, 2.0, [](double t) { return 4.0 * std::sqrt(t); })), 0.5, 1.0e-12);
    EXPECT_NEAR(take(Take::Rate, readings(20, 2.0, [](double t) { return 4.0 * std::exp(-1.5 * t); })), 1.5, 1.0e-12);
}

TEST(Take, PeriodAndEnvelopeOfADampedSwing)
{
    constexpr double kPeriod = 0.7, kRate = 0.1;
    // Whole periods, else their mean is not what they swing about; damping shifts it by as little as the figures say.
    const auto all =
        readings(4000, 10.0 * kPeriod, [](double t) { return 5.0 + std::exp(-kRate * t) * std::sin(2.0 * std::numbers::pi * t / kPeriod); });
    EXPECT_NEAR(take(Take::Period, all), kPeriod, 1.0e-3 * kPeriod);
    EXPECT_NEAR(take(Take::EnvelopeRate, all), kRate, 0.02 * kRate);
}

TEST(Take, ErrorsAreRelativeToWhatIsKnown)
{
    const std::vector<Reading> all = {{0, 1.0, 2.0}, {1, 2.2, 2.0}};
    EXPECT_NEAR(take(Take::MeanError, all), 0.3, 1.0e-12);
    EXPECT_NEAR(take(Take::LargestError, all), 0.5, 1.0e-12);
}

TEST(Take, RmsErrorIsRelativeToTheWayOfWhatIsKnown)
{
    // What is known goes from 2 to 5 and 6: 3 and 4 away from where it began.
    const std::vector<Reading> all = {{0, 2.0, 2.0}, {1, 5.0, 5.0}, {2, 8.0, 6.0}};
    EXPECT_NEAR(take(Take::RmsError, all), 2.0 / 5.0, 1.0e-12);
}

TEST(Take, IsNotANumberWhereThereAreTooFewReadings)
{
    EXPECT_TRUE(std::isnan(take(Take::Last, {})));
    const std::vector<Reading> one = {{1, 1, 1}}, rising = {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}};
    EXPECT_TRUE(std::isnan(take(Take::Slope, one)));
    EXPECT_TRUE(std::isnan(take(Take::Period, rising)));
    EXPECT_TRUE(std::isnan(take(Take::EnvelopeRate, rising)));
    EXPECT_TRUE(std::isnan(take(Take::Reach, rising, 3.0)));
}

}  // namespace
}  // namespace app
