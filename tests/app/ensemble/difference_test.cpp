// Two ensembles of numbers that are drawn.
#include "app/ensemble/difference.h"
#include "sim/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace app::test {
namespace {

using Draw = std::function<double(double first, double second)>;  ///< of two numbers in [0, 1)

const std::map<std::string, Draw> kDistributions = {
    {"normal", [](double a, double b) { return std::sqrt(-2.0 * std::log1p(-a)) * std::cos(2.0 * std::numbers::pi * b); }},
    {"even", [](double a, double) { return a; }},
    {"of two values", [](double a, double) { return a < 0.5 ? 0.0 : 1.0; }},
    {"exponential", [](double a, double) { return -std::log1p(-a); }},
    {"with rare large values", [](double a, double) { return std::pow(1.0 - a, -0.5); }},
};

/// Columns that have nothing to do with each other.
std::vector<EnsembleColumn> drawn(const Draw& draw, int runs, std::uint64_t number)
{
    constexpr int kColumns = 20;
    const sim::CounterRandom random(number, 7);
    std::vector<EnsembleColumn> columns;
    for (int c = 0; c < kColumns; ++c) {
        columns.push_back({.name = std::to_string(c), .values = {}});
        for (int n = 0; n < runs; ++n) {
            const auto place = static_cast<std::uint64_t>(c * runs + n);
            columns.back().values.push_back(draw(random.uniform(place, 0), random.uniform(place, 1)));
        }
    }
    return columns;
}

/// How many of 2000 pairs of ensembles of one distribution seem to differ.
int falseAlarms(const Draw& draw, int runs)
{
    int alarms = 0;
    for (std::uint64_t pair = 0; pair < 2000; ++pair)
        alarms += differenceOf(drawn(draw, runs, 2 * pair), drawn(draw, runs, 2 * pair + 1), 0.99).seen() > 0 ? 1 : 0;
    return alarms;
}

TEST(EnsembleDifference, FalseAlarmsAreOnePercentAtMost)
{
    for (const auto& [name, draw] : kDistributions)
        for (const int runs : {5, 20}) EXPECT_LE(falseAlarms(draw, runs), 20) << name << ", " << runs << " runs";
}

TEST(EnsembleDifference, AShiftOfTwoDeviationsIsFound)
{
    const Draw& normal = kDistributions.at("normal");
    int found = 0;
    for (std::uint64_t pair = 0; pair < 200; ++pair) {
        std::vector<EnsembleColumn> moved = drawn(normal, 20, 2 * pair + 1);
        for (double& x : moved[3].values) x += 2.0;
        found += differenceOf(drawn(normal, 20, 2 * pair), moved, 0.99).seen() > 0 ? 1 : 0;
    }
    EXPECT_GE(found, 190);
}

TEST(EnsembleDifference, WhatIsConstantAndWhatIsOfTheMachineIsNotJudged)
{
    const std::vector<EnsembleColumn> a = {{.name = "particles, mean", .values = std::vector(8, 7.0)},
                                           {.name = "sum, mean", .values = {1.0, 1.0 + 1.0e-13, 1.0}},
                                           {.name = "height, mean", .values = {1.0, 1.1, 0.9}},
                                           {.name = "wall_s", .values = {1.0, 1.0, 1.0}, .isOfMachine = true}};
    std::vector<EnsembleColumn> b = a;
    b[3].values = {9.0, 9.0, 9.0};
    EnsembleDifference difference = differenceOf(a, b, 0.99);
    EXPECT_EQ(difference.seen(), 0u);
    ASSERT_EQ(difference.judged.size(), 1u);
    EXPECT_EQ(difference.constant, (std::vector<std::string>{"particles", "sum"}));
    ASSERT_EQ(difference.ofMachine.size(), 1u);
    EXPECT_NE(sentenceOf(difference).find("No difference seen"), std::string::npos);

    b[0].values = std::vector(8, 8.0);
    difference = differenceOf(a, b, 0.99);
    EXPECT_EQ(difference.seen(), 1u) << "seven particles in all runs are not eight in all runs";
    EXPECT_NE(sentenceOf(difference).find("most clearly in particles, mean: 8 against 7"), std::string::npos) << sentenceOf(difference);
    EXPECT_NE(differenceTable(difference).find("**differs**"), std::string::npos);
}

TEST(EnsembleDifference, OneRunTellsNothing)
{
    const std::vector<EnsembleColumn> a = {{.name = "x", .values = {1.0}}}, b = {{.name = "x", .values = {2.0}}};
    const EnsembleDifference difference = differenceOf(a, b, 0.99);
    EXPECT_EQ(difference.seen(), 0u);
    EXPECT_NE(differenceTable(difference).find("too few runs"), std::string::npos);
}

}  // namespace
}  // namespace app::test
