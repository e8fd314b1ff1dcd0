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

constexpr int kTrials = 1000;

/// How often two ensembles of one distribution seem to differ.
int falseAlarms(const Draw& draw, int runs, bool isPaired)
{
    int alarms = 0;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial)
        alarms += differenceOf(drawn(draw, runs, 2 * trial), drawn(draw, runs, 2 * trial + 1), 0.99, isPaired).seen() > 0 ? 1 : 0;
    return alarms;
}

TEST(EnsembleDifference, FalseAlarmsAreOnePercentAtMost)
{
    for (const auto& [name, draw] : kDistributions)
        for (const int runs : {5, 20})
            for (const bool isPaired : {false, true}) {
                EXPECT_LE(falseAlarms(draw, runs, isPaired), kTrials / 100) << name << ", " << runs << (isPaired ? " pairs" : " runs");
            }
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

TEST(EnsembleDifference, PairsTellWhatTheirSpreadWouldHide)
{
    const std::vector<EnsembleColumn> a = {{.name = "kinetic_erg, mean", .values = {1.0, 5.0, 9.0, 3.0, 2.0, 7.0}}};
    std::vector<EnsembleColumn> b = a;
    for (std::size_t n = 0; n < 6; ++n) b[0].values[n] += n % 2 == 0 ? 0.010 : 0.011;
    EXPECT_EQ(differenceOf(a, b, 0.99).seen(), 0u);
    EXPECT_EQ(differenceOf(a, b, 0.99, true).seen(), 1u);
    EXPECT_EQ(differenceOf(a, a, 0.99, true).judged.size(), 0u) << "pairs that are the same differ in nothing";
    b = a;
    for (std::size_t n = 0; n < 6; ++n) b[0].values[n] *= 1.0 + 1.0e-12 * static_cast<double>(n + 1);
    EXPECT_EQ(differenceOf(a, b, 0.99, true).judged.size(), 0u) << "rounding is no difference";
}

TEST(EnsembleDifference, NoShareIsToldOfWhatIsNextToZero)
{
    const std::vector<EnsembleColumn> a = {{.name = "height [cm], mean", .values = {1.0, 1.1, 0.9}},
                                           {.name = "sway [dyn]", .values = {-3.0, 3.5, -0.2}}};
    std::vector<EnsembleColumn> b = a;
    for (double& x : b[1].values) x += 1000.0;
    b[0].values[0] = 1.01;
    const EnsembleDifference difference = differenceOf(a, b, 0.99);
    const std::string table = differenceTable(difference), sway = table.substr(table.find("| sway"));
    EXPECT_NE(table.substr(0, table.find("| sway")).find(" %"), std::string::npos) << table;
    EXPECT_EQ(sway.find(" %"), std::string::npos) << sway;
    EXPECT_NE(sentenceOf(difference).find("sway [dyn]: 1000.1 against 0.1, a difference of "), std::string::npos) << sentenceOf(difference);
}

TEST(EnsembleDifference, WhatIsNothingBesideItsKindIsConstant)
{
    const std::vector<EnsembleColumn> a = {{.name = "kinetic_erg, mean", .values = {1.0, 5.0, 9.0}},
                                           {.name = "modal_erg, mean", .values = {1.0e-29, 1.1e-29, 1.2e-29}},
                                           {.name = "forces/floor/liquid/mean_force[1] [dyn]", .values = {-7.0, -7.1, -7.2}},
                                           {.name = "forces/floor/liquid/mean_torque[0] [dyn cm]", .values = {1.0e-13, 1.1e-13, 2.0e-13}}};
    std::vector<EnsembleColumn> b = a;
    for (double& x : b[1].values) x *= 2.0;
    const EnsembleDifference difference = differenceOf(a, b, 0.99);
    EXPECT_EQ(difference.constant, (std::vector<std::string>{"modal_erg"}));
    EXPECT_EQ(difference.judged.size(), 3u) << "torques have no other to be small beside";
}

}  // namespace
}  // namespace app::test
