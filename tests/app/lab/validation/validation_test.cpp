#include "app/lab/validation/run_case.h"
#include "app/lab/validation/validation_plot.h"
#include "app/lab/validation/validation_report.h"
#include "sim/core/check.h"
#include "tests/app/fake_backends.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace app {
namespace {

sim::SceneFile caseOf(const std::string& section) { return sim::sceneFileFromText(fmt::format("drench: 1\nvalidate:\n{}", section), "case.yaml"); }

/// The toy's one particle of 2 g flies along x at 1 cm/s.
CaseResult fly(const std::string& checks, const test::ToySettings& toy = {}, const std::string& more = "")
{
    LoadedScene setup = test::toySetup(toy);
    setup.file = caseOf(fmt::format("  every: 0.01\n  let: {{one: 0.5 + 0.5}}\n{}  checks:\n{}", more, checks));
    return runCase("flight", setup, test::toyBackends(toy), [] { return false; });
}

TEST(Validation, ComparesReadingsWithWhatIsKnown)
{
    const CaseResult result =
        fly("    - {read: liquid_x, expect: one*t, tolerance: 1.0e-9}\n"
            "    - {read: liquid_mass, expect: 3, within: 0.5}\n"
            "    - {read: liquid_x, take: slope, at_least: 0.9, at_most: 1.1}\n"
            "    - {read: liquid_x, against: 100*t, from: 1.5, to: 3.5, take: mean, expect: 0.025, tolerance: 1.0e-9}\n"
            "    - {read: liquid_x + 1, table: [[0, 1], [0.1, 1.1]], take: largest_error, at_most: 1.0e-9}\n");
    ASSERT_EQ(result.findings.size(), 5u);
    for (const std::size_t right : {0u, 2u, 3u, 4u}) EXPECT_TRUE(result.findings[right].passes) << right << ": " << result.findings[right].value;
    EXPECT_FALSE(result.findings[1].passes);
    EXPECT_FALSE(result.passes());
    EXPECT_EQ(result.readings[0].size(), 6u);
    EXPECT_EQ(result.readings[3].size(), 2u);
}

/// Steps of 0.004, 0.004 and 0.002 s between two readings: the first three push by 1, 2 and 3 dyn.
TEST(Validation, ForcesAreMeansSinceTheLastReading)
{
    const CaseResult result =
        fly("    - {read: 'force_x(\"wall\")', to: 0.015, take: last, expect: 1.8, tolerance: 1.0e-9}\n"
            "    - {read: 'torque_z(\"wall\")', from: 0.015, to: 0.025, take: last, expect: -3*4.8, tolerance: 1.0e-9}\n"
            "    - {read: 'contact_force_x(\"wall\") + liquid_force_x(\"sheet\")', take: last, expect: 0, within: 0}\n"
            "    - {read: 'contact_force_x(\"sheet\")/force_x(\"wall\")', from: 0.005, expect: -1, tolerance: 1.0e-9}\n"
            "    - {read: 'pin_force_x(\"left\")/force_x(\"wall\")', from: 0.005, expect: 2, tolerance: 1.0e-9}\n"
            "    - {read: 'pin_torque_z(\"sheet\")/force_x(\"wall\")', from: 0.005, expect: -9, tolerance: 1.0e-9}\n",
            {.push = 1.0});
    ASSERT_EQ(result.findings.size(), 6u) << result.failure;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(result.findings[i].passes) << i << ": " << result.findings[i].value;
}

/// The toy is at 1, 1.01, … 1.05; the band is 0.01 wide to both sides of 1.01 and 1.03, linear between.
TEST(Validation, ReadingsAreHeldAgainstTheBandThatWasMeasured)
{
    const std::string table = "table: [[0.01, 1.01, 1.0, 1.02], [0.03, 1.01, 1.0, 1.02], [0.04, 1.04, 1.03, 1.05]]";
    const CaseResult result = fly("    - {read: liquid_x + 1, take: share_inside, at_least: 0.75, " + table +
                                  "}\n"
                                  "    - {read: liquid_x + 1, take: share_inside, at_least: 0.76, " +
                                  table + "}\n");
    ASSERT_EQ(result.findings.size(), 2u) << result.failure;
    EXPECT_EQ(result.readings[0].size(), 4u) << "none is held against what was not measured";
    EXPECT_DOUBLE_EQ(result.readings[0][1].upper, 1.02);
    EXPECT_DOUBLE_EQ(result.findings[0].value, 0.75);
    EXPECT_TRUE(result.findings[0].passes);
    EXPECT_FALSE(result.findings[1].passes);
}

/// At 0.03 s the toy is at 0.03; what is read there at 0, 1 and 4 is 0.03, 1.03 and 4.03.
TEST(Validation, ProfilesAreReadOnceAtThePlacesOfTheirTable)
{
    const std::string profile = "read: liquid_x + s, take: rms_difference, at_most: 0.11, table: [[0, 0.03], [1, 1.13], [4, 3.88, 3.8, 3.9]]";
    const std::string banded = "read: liquid_x + s, take: share_inside, at_least: 0.6, table: [[0, 0, 0, 0.1], [1, 1, 0.9, 1.1], [4, 3, 2, 4]]";
    const std::string plain = "read: liquid_x + s, unit: cm, take: rms_difference, at_most: 0.11, table: [[0, 0.03], [1, 1.13], [4, 3.88]]";
    EXPECT_THROW(fly("    - {at: 0.03, " + profile + "}\n"), sim::InputError) << "rows have a band or none";
    const CaseResult result = fly("    - {at: 0.03, name: then, " + plain + "}\n    - {at: 0.05, name: later, " + plain + "}\n    - {at: 0.03, " +
                                  banded + "}\n    - {read: liquid_x, at_most: 1}\n");
    ASSERT_EQ(result.findings.size(), 4u) << result.failure;
    ASSERT_EQ(result.readings[0].size(), 3u);
    EXPECT_EQ(result.readings[0][2].at, 4.0);
    EXPECT_NEAR(result.readings[0][2].value, 4.03, 1.0e-12);
    EXPECT_NEAR(result.findings[0].value, std::sqrt((0.1 * 0.1 + 0.15 * 0.15) / 3.0), 1.0e-12);
    EXPECT_NEAR(result.findings[1].value, std::sqrt((0.02 * 0.02 + 0.08 * 0.08 + 0.17 * 0.17) / 3.0), 1.0e-12);
    EXPECT_NEAR(result.findings[2].value, 2.0 / 3.0, 1.0e-12);
    EXPECT_EQ(panelsOf(result.validation.checks).size(), 3u) << "profiles of two times have two panels";
    EXPECT_NE(validationPlotScript(result, "flight.png").find("set xlabel 's [cm]'"), std::string::npos);
    EXPECT_NE(findingsTable({result}).find("| then | 0.10408 cm |"), std::string::npos) << findingsTable({result});
}

TEST(Validation, ReadingsWithoutAValueAreWhatTheCheckSays)
{
    const CaseResult dry = fly("    - {read: \"surface_y(9, 9)\", otherwise: -2, expect: -2, within: 0}\n");
    EXPECT_TRUE(dry.passes()) << dry.failure;
    EXPECT_FALSE(fly("    - {read: \"surface_y(9, 9)\", expect: -2, within: 0}\n").passes());
}

/// A limit of the model is told with what is found, and fails nothing; a run that finds nothing does.
TEST(Validation, WhatIsSaidToBeOutsideIsTold)
{
    const CaseResult result =
        fly("    - {name: level, read: liquid_x + 1, expect: 2, tolerance: 0.2, outside: it only flies}\n"
            "    - {name: near, read: liquid_x + 1, expect: 1, tolerance: 0.2}\n"
            "    - {name: better, read: liquid_x + 1, expect: 1, tolerance: 0.2, outside: so it was once}\n",
            {}, "  kind: measured\n");
    EXPECT_TRUE(result.passes());
    const std::string report = validationReport({result}, false, false);
    for (const char* part : {"1 of 1 cases pass", "## Measured", "| level | 1.05 | 2 | -47.50 % | within 20 % | outside, as said below |",
                             "| within 20 % | inside |", "| inside, said to be outside |", "Outside: level. it only flies"})
        EXPECT_NE(report.find(part), std::string::npos) << part << "\n" << report;
    EXPECT_EQ(report.find("## Theory"), std::string::npos);

    const CaseResult plain = fly("    - {read: liquid_x + 1, expect: 2, tolerance: 0.2}\n", {}, "  kind: measured\n");
    EXPECT_FALSE(plain.passes());
    EXPECT_NE(validationReport({plain}, false, false).find("| **outside** |"), std::string::npos);
    EXPECT_FALSE(fly("    - {read: liquid_x, take: period, at_most: 9, outside: it only flies}\n", {}, "  kind: measured\n").passes());
}

/// A paper draws a course once, with all that is known of it: the largest value, its time, and the band of another check of the same reading.
TEST(Validation, ChecksOfOneReadingShareAPanel)
{
    const CaseResult result =
        fly("    - {name: peak, unit: cm, read: liquid_x + 1, take: largest, expect: 1.1, tolerance: 0.2}\n"
            "    - {name: its time, unit: s, read: liquid_x + 1, take: largest_at, expect: 0.04, within: 0.1}\n"
            "    - {name: other, read: liquid_mass, expect: 2, within: 1}\n"
            "    - {name: course, unit: cm, read: liquid_x + 1, take: share_inside, at_least: 0.5, table: [[0, 1, 0.9, 1.1], [1, 2, 1.9, 2.1]]}\n",
            {}, "  kind: measured\n");
    ASSERT_EQ(result.findings.size(), 4u) << result.failure;
    EXPECT_EQ(panelsOf(result.validation.checks), (std::vector<std::vector<std::size_t>>{{0, 1, 3}, {2}}));
    const std::string script = validationPlotScript(result, "flight.png");
    for (const char* part : {"layout 1,2", "set title 'course'", "set ylabel '[cm]'", "title 'scatter'", "(0.04):($0==0?1:1.05)", "title 'found'",
                             "set xtics 0.01\n", "($4-1):($4+1)", "title 'allowed'"})
        EXPECT_NE(script.find(part), std::string::npos) << part << "\n" << script;
    EXPECT_EQ(script.find("set title 'peak'"), std::string::npos) << script;
    EXPECT_EQ(script.find("($4*0.8)"), std::string::npos) << "where the course has a band";
}

TEST(Validation, WhatHasNoValueFails)
{
    EXPECT_FALSE(fly("    - {read: liquid_x, take: period, at_most: 1.0e9}\n").passes());
    const CaseResult broken = fly("    - {read: vertex_x(3), at_most: 1}\n");
    EXPECT_FALSE(broken.passes());
    EXPECT_NE(broken.failure.find("no vertex 3"), std::string::npos) << broken.failure;
}

TEST(Validation, ARunThatFailsIsACaseThatFails)
{
    const CaseResult result = fly("    - {read: liquid_x, at_most: 1}\n", {.failAtStep = 3});
    EXPECT_FALSE(result.passes());
    const std::string report = validationReport({result}, false, false);
    EXPECT_NE(report.find("the toy fell over"), std::string::npos) << report;
    EXPECT_NE(report.find("0 of 1 cases pass"), std::string::npos) << report;
}

TEST(Validation, MistakesNameTheirLine)
{
    const auto mistake = [](const std::string& section) -> std::string {
        try {
            LoadedScene setup;
            setup.file = caseOf(section);
            readValidation(setup);
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    const std::vector<std::pair<std::string, std::string>> all = {
        {"  checks: [{read: 1, at_most: 1}]\n", "case.yaml:2: validate.every is missing"},
        {"  every: 0\n  checks: [{read: 1, at_most: 1}]\n", "case.yaml:3: validate.every: must be above 0"},
        {"  every: 1\n", "case.yaml:2: validate.checks is missing"},
        {"  every: 1\n  quick: true\n", "case.yaml:4: validate.quick: needs a map"},
        {"  every: 1\n  checks: []\n", "case.yaml:4: validate.checks: needs a list"},
        {"  every: 1\n  checks:\n    - {read: sped, at_most: 1}\n", "case.yaml:5: validate.checks.0.read: \"sped\""},
        {"  every: 1\n  checks:\n    - {read: 'force_y(\"bal\")', at_most: 1}\n",
         "case.yaml:5: validate.checks.0.read: \"force_y(\"bal\")\": there is no obstacle and no fabric \"bal\""},
        {"  every: 1\n  checks:\n    - {read: 'pin_force_y(\"bal\")', at_most: 1}\n",
         "case.yaml:5: validate.checks.0.read: \"pin_force_y(\"bal\")\": no pins and no fabric with pins are called \"bal\""},
        {"  every: 1\n  checks:\n    - {read: speed}\n", "case.yaml:5: validate.checks.0: needs expect with a tolerance"},
        {"  every: 1\n  checks:\n    - {read: speed, expect: 1}\n", "case.yaml:5: validate.checks.0: expect needs tolerance"},
        {"  every: 1\n  checks:\n    - {read: speed, take: mean_error, at_most: 1}\n",
         "case.yaml:5: validate.checks.0: an error needs expect or table"},
        {"  every: 1\n  checks:\n    - {read: speed, take: last, table: [[0, 1]], at_most: 1}\n",
         "case.yaml:5: validate.checks.0: a table is compared by take: mean_error, largest_error, rms_error, rms_difference or share_inside"},
        {"  every: 1\n  checks:\n    - {read: s, at: 1, at_most: 1}\n", "case.yaml:5: validate.checks.0.at: a profile needs a table"},
        {"  every: 1\n  checks:\n    - {read: s, at: 1.5, take: rms_error, table: [[0, 1], [1, 2]], at_most: 1}\n",
         "case.yaml:5: validate.checks.0.at: nothing is read at 1.5 s: needs a multiple of every, 1 s"},
        {"  every: 1\n  checks:\n    - {read: s, at: 99, take: rms_error, table: [[0, 1], [1, 2]], at_most: 1}\n",
         "case.yaml:5: validate.checks.0.at: nothing is read at 99 s"},
        {"  every: 1\n  checks:\n    - {read: s, at: 1, from: 0, take: rms_error, table: [[0, 1], [1, 2]], at_most: 1}\n",
         "case.yaml:5: validate.checks.0.at: a profile needs a table"},
        {"  every: 1\n  checks:\n    - {read: speed, take: share_inside, table: [[0, 1], [1, 2]], at_least: 0.8}\n",
         "case.yaml:5: validate.checks.0: share_inside needs a table with a band, like [[0, 1, 0.9, 1.1]"},
        {"  every: 1\n  checks:\n    - {read: speed, take: share_inside, table: [[0, 1, 0, 2], [1, 2]], at_least: 0.8}\n",
         "case.yaml:5: validate.checks.0.table"},
        {"  every: 1\n  checks:\n    - {read: speed, take: share_inside, table: [[0, 1, 1.5, 2]], at_least: 0.8}\n",
         "case.yaml:5: validate.checks.0.table: a row with a band is [against, value, lower, upper]"},
        {"  every: 1\n  kind: guessed\n  checks: [{read: 1, at_most: 1}]\n", "case.yaml:4: validate.kind"},
        {"  every: 1\n  checks:\n    - {read: speed, at_most: 1, outside: too fast}\n",
         "case.yaml:5: validate.checks.0.outside: is for what was measured: validate needs kind: measured"},
        {"  every: 1\n  checks:\n    - {read: speed, take: middle, at_most: 1}\n", "case.yaml:5: validate.checks.0.take"},
        {"  every: 1\n  checks:\n    - {read: speed, at_most: 1, colour: 3}\n", "unknown key \"colour\""},
        {"  every: 1\n  flow: [\"1\", \"2\"]\n  checks: [{read: 1, at_most: 1}]\n", "case.yaml:4: validate.flow: needs three formulas"},
        {"  every: 1\n  let: {k: pi/}\n  checks: [{read: 1, at_most: 1}]\n", "case.yaml:4: validate.let.k"},
    };
    for (const auto& [section, message] : all) EXPECT_NE(mistake(section).find(message), std::string::npos) << section << mistake(section);
}

}  // namespace
}  // namespace app
