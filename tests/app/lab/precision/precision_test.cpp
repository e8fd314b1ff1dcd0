#include "app/lab/precision/precision_plot.h"
#include "app/lab/precision/precision_report.h"
#include "app/lab/precision/precision_table.h"
#include "app/lab/precision/reference_run.h"
#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/scene/scene_file.h"
#include "tests/app/fake_backends.h"
#include "tests/app/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace app {
namespace {

/// The toy's one particle flies along x at `speed`; where cells are below nothing it falls over.
constexpr const char* kFlight =
    "drench: 1\nspeed: 1\ntime: {dt: 0.01}\nprecision:\n  every: 0.01\n  energy: kinetic\n  decay: 4\n  speed: 100\n"
    "  errors: [{read: liquid_x, take: rms_error, expect: t}]\n"
    "  methods: [{name: slow, speed: 1}, {name: fast, speed: 1.1}]\n"
    "  steps: [{name: long, time.dt: 0.01}, {name: short, time.dt: 0.005}, {name: by cells, cells: 0.5}]\n"
    "  quick: {methods: [fast], steps: [long, short]}\n"
    "  published: {method: fast, step: short}\n";

double numberAt(const sim::SceneFile& file, const std::string& section, const std::string& key)
{
    const sim::Node* node = section.empty() ? &file.root : file.root.find(section);
    return std::stod(node->find(key)->text);
}

Backends flightParts(const std::string& text)
{
    Backends backends = test::toyBackends({});
    backends.loadScene = [text](const SceneRequest& request) {
        const sim::SceneFile file = sim::sceneFileFromText(text, "flight.yaml", {.variant = "", .set = request.sets});
        LoadedScene setup = test::toySetup({.dt = numberAt(file, "time", "dt"), .speed = numberAt(file, "", "speed")});
        setup.scene.settings.cell = 0.2;
        setup.file = file;
        return setup;
    };
    backends.startSimulation = [](const LoadedScene& setup) {
        const double speed = std::stod(setup.identity.substr(setup.identity.find("speed: ") + 7));
        return test::toyBackends({.dt = setup.scene.settings.time.dt, .speed = speed, .failAtStep = setup.scene.settings.cell < 0.0 ? 1 : 0})
            .startSimulation(setup);
    };
    return backends;
}

bool never() { return false; }

PrecisionRow measure(const PrecisionRun& run, const Backends& backends) { return measurePrecision(run, {}, 1, 1, backends, never); }

TEST(Precision, RunsEveryCombinationOfItsChoices)
{
    const Backends backends = flightParts(kFlight);
    const auto all = precisionRuns("", backends, false), quick = precisionRuns("", backends, true);
    EXPECT_EQ(all.size(), 6u);
    ASSERT_EQ(quick.size(), 2u);
    EXPECT_EQ(quick[0].names, (PrecisionNames{"fast", "-", "long", "-"}));
    EXPECT_NE(quick[0].settings, quick[1].settings);
}

TEST(Precision, TellsErrorStepsAndEnergyOfARun)
{
    const Backends backends = flightParts(kFlight);
    for (const PrecisionRun& run : precisionRuns("", backends, false)) {
        const PrecisionRow row = measure(run, backends);
        const bool isFast = run.names.method == "fast";
        EXPECT_NEAR(row.error, isFast ? 0.1 : 0.0, 1.0e-12);
        EXPECT_NEAR(row.energyLeft, 1.0, 1.0e-12);
        EXPECT_NEAR(row.viscosity, 0.0, 1.0e-12);
        EXPECT_EQ(row.steps, run.names.step == "long" ? 5 : run.names.step == "short" ? 10 : 50) << run.names.step;
        EXPECT_NEAR(row.dt * static_cast<double>(row.steps), 0.05, 1.0e-12);
        EXPECT_GT(row.wallSeconds, 0.0);
    }
}

TEST(Precision, HoldsRunsAgainstAConvergedOne)
{
    test::TemporaryFolder folder;
    std::string text = kFlight;
    text.replace(text.find(", expect: t"), 11, "");
    text += "  converged: {speed: 2}\n";
    const Backends backends = flightParts(text);
    const LoadedScene setup = convergedSetup("", backends);
    const auto file = folder.path() / "flight_converged.csv";
    const auto readings = convergedReadings(file, setup, 1, backends, never);
    const auto run = precisionRuns("", backends, false).front();
    EXPECT_NEAR(measurePrecision(run, readings, 1, 1, backends, never).error, 0.5, 1.0e-12);

    LoadedScene falling = setup;  // it would fall over, but is read and not run
    falling.scene.settings.cell = -1.0;
    const auto again = convergedReadings(file, falling, 1, backends, never);
    EXPECT_NEAR(measurePrecision(run, again, 1, 1, backends, never).error, 0.5, 1.0e-9);
}

TEST(Precision, ARunThatFailsIsARowOfItsOwn)
{
    const Backends backends = flightParts(kFlight);
    PrecisionRun run = precisionRuns("", backends, true).front();
    run.setup.scene.settings.cell = -1.0;
    const PrecisionRow row = measure(run, backends);
    EXPECT_FALSE(row.isDone());
    EXPECT_NE(row.outcome.find("the toy fell over"), std::string::npos) << row.outcome;
    EXPECT_TRUE(std::isnan(row.error));
}

TEST(Precision, TableKnowsWhichRunsItHas)
{
    test::TemporaryFolder folder;
    const Backends backends = flightParts(kFlight);
    const auto file = folder.path() / "precision.csv";
    PrecisionRun run = precisionRuns("", backends, true).front();
    PrecisionTable(file).add(measure(run, backends));
    const PrecisionTable table(file);
    ASSERT_TRUE(table.find(run, 1, 1));
    EXPECT_NEAR(table.find(run, 1, 1)->error, 0.1, 1.0e-6);
    EXPECT_FALSE(table.find(run, 2, 1)) << "on other threads it takes another time";
    EXPECT_FALSE(table.find(run, 1, 3)) << "of more repeats";
    run.settings = "0123456789abcdef";
    EXPECT_FALSE(table.find(run, 1, 1)) << "of other settings";
}

TEST(Precision, TableRefusesFilesThatAreNoneOfIts)
{
    test::TemporaryFolder folder;
    const auto mistake = [&](const std::string& text) -> std::string {
        writeWhole(folder.path() / "precision.csv", text);
        try {
            readPrecisionCsv(folder.path() / "precision.csv");
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    const std::string header = precisionCsv({});
    EXPECT_EQ(mistake(header), "");
    EXPECT_NE(mistake("a,b,c\n").find("precision.csv:1:"), std::string::npos);
    EXPECT_NE(mistake(header + "1,2\n").find("precision.csv:2:"), std::string::npos);
    PrecisionRow row;
    row.scene = row.settings = "a";
    row.names = {"a", "b", "c", "d"};
    EXPECT_EQ(mistake(precisionCsv({row})), "");
    std::string text = precisionCsv({row});
    text.replace(text.find(",0,0,0,"), 4, ",0,x");
    EXPECT_NE(mistake(text).find("precision.csv:2:"), std::string::npos) << text;
}

/// A case with the rows of the published scheme at 8 s and of ours.
PrecisionCase caseOf(const std::vector<Cost>& ours)
{
    const Backends backends = flightParts(kFlight);
    const auto runs = precisionRuns("", backends, false);
    PrecisionCase of{"flight", "Flight", *readPrecision(runs.front().setup), {}};
    const auto add = [&](const std::string& method, const std::string& step, const Cost& cost) {
        PrecisionRow& row = of.rows.emplace_back();
        row.names = {method, "-", step, "-"};
        row.wallSeconds = cost.seconds;
        row.error = cost.error;
    };
    add("fast", "short", {8.0, 0.1});
    for (const Cost& cost : ours) add("slow", "long", cost);
    return of;
}

TEST(Precision, SaysWhatPartOfTheRunTimeIsNeeded)
{
    EXPECT_NE(gainSentence(caseOf({{1.0, 1.0}, {4.0, 0.01}})).find("1/4.0 of the run time of the published scheme"), std::string::npos);
    EXPECT_NE(gainSentence(caseOf({{0.5, 0.05}})).find("1/16.0 of"), std::string::npos);
    EXPECT_NE(gainSentence(caseOf({{9.0, 0.2}})).find("1/1.0 of"), std::string::npos) << "no gain is no loss: it may be used itself";
    PrecisionCase without = caseOf({{1.0, 1.0}});
    without.precision.published = {};
    EXPECT_EQ(gainSentence(without), "");
}

/// The key of a plot is cut off where it has fewer rows than names stand below each other.
TEST(Precision, PlotsNameAllOfTheirCurves)
{
    for (const std::size_t letters : {5, 21, 44}) {
        PrecisionCase of = caseOf({});
        of.precision.integrators = {{"-", {}}};
        of.precision.methods.clear();
        of.rows.clear();
        for (int m = 0; m < 14; ++m) {
            const std::string name = fmt::format("{:{}}", m, letters);
            of.precision.methods.push_back({name, {}});
            PrecisionRow& row = of.rows.emplace_back();
            row.names = {name, "-", "short", "-"};
            row.wallSeconds = row.error = 1.0 + m;
        }
        const std::string script = workPrecisionScript({&of}, "plot.png");
        std::size_t rows = 0;
        ASSERT_EQ(std::sscanf(script.c_str() + script.find("maxrows"), "maxrows %zu", &rows), 1);
        const std::size_t columns = (16 + rows - 1) / rows;
        EXPECT_LE(columns * (letters * 7 + 40), 640u) << letters << " letters in " << rows << " rows";
        int height = 0;
        ASSERT_EQ(std::sscanf(script.c_str() + script.find("size 640,"), "size 640,%d", &height), 1);
        EXPECT_GE(height, 400 + 14 * static_cast<int>(rows));
    }
}

TEST(Precision, MistakesNameTheirLine)
{
    const auto mistake = [](const std::string& from, const std::string& to) -> std::string {
        std::string text = kFlight;
        text.replace(text.find(from), from.size(), to);
        try {
            readPrecision(flightParts(text).loadScene({}));
        } catch (const sim::InputError& error) {
            return error.what();
        }
        return "";
    };
    const std::vector<std::array<std::string, 3>> all = {
        {"  every: 0.01\n", "", "precision.every is missing"},
        {"energy: kinetic", "energy: kinetik", "flight.yaml:6: precision.energy: \"kinetik\""},
        {", expect: t", "", "precision.converged is missing"},
        {"  decay: 4\n", "  converged: true\n", "flight.yaml:7: precision.converged: needs a map"},
        {"take: rms_error, expect: t", "take: mean", "flight.yaml:9: precision.errors.0: needs expect"},
        {"name: slow", "nome: slow", "flight.yaml:10: precision.methods.name is missing"},
        {"methods: [fast]", "methods: [fats]", "flight.yaml:12: precision.quick.methods: there is no \"fats\""},
        {"step: short", "step: shirt", "flight.yaml:13: precision.published.step: there is no \"shirt\""},
        {"decay", "decoy", "unknown key \"decoy\""}};
    for (const auto& [from, to, expected] : all) EXPECT_NE(mistake(from, to).find(expected), std::string::npos) << mistake(from, to);
}

}  // namespace
}  // namespace app
