// Files of a run that was made when fields were called otherwise (RUN_BEFORE_RENAMING) are read under the names of now.

#include "app/diff/diff.h"
#include "app/diff/series.h"
#include "app/provenance/repeat.h"
#include "app/reports/energy_plot.h"
#include "app/reports/run_report.h"
#include "sim/renamed.h"
#include "sim/scene/load_scene.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

namespace app {
namespace {

const std::filesystem::path kOld = RUN_BEFORE_RENAMING;

std::array<int, 3> numbersOf(const std::string& version)
{
    std::array<int, 3> numbers{};
    EXPECT_EQ(std::sscanf(version.c_str(), "%d.%d.%d", &numbers[0], &numbers[1], &numbers[2]), 3) << version;
    return numbers;
}

/// If this fails the rows of sim/renamed.cpp go, and with them what reads old names.
TEST(RenamedFields, AreReadUntilTheVersionThatDropsThem) { EXPECT_LT(numbersOf(THIS_VERSION), numbersOf(std::string(sim::kOldNamesEnd))); }

TEST(RenamedFields, HaveOneNameEach)
{
    std::set<std::string_view> before, now;
    for (const sim::Renamed& row : sim::renamedFields()) {
        EXPECT_TRUE(before.insert(row.before).second) << row.before;
        EXPECT_TRUE(now.insert(row.now).second) << row.now;
        EXPECT_EQ(sim::currentName(row.before), row.now);
        EXPECT_EQ(sim::currentName(std::string(row.before) + "[2]"), std::string(row.now) + "[2]");
        EXPECT_EQ(sim::formerName(row.now), row.before);
        EXPECT_EQ(sim::currentName(row.now), row.now);
        EXPECT_EQ(sim::currentName(std::string(row.before) + "s"), std::string(row.before) + "s");
    }
}

/// Every row of the table that is in one of the three files.
TEST(RenamedFields, OfFilesWrittenBeforeAreColumnsOfNow)
{
    std::set<std::string> columns;
    const auto take = [&](const Series& series) {
        for (const std::string& column : series.columns) columns.insert(column.substr(0, column.find('[')));
    };
    take(readReportNumbers(kOld / "report.json"));
    for (const char* log : {"steps.jsonl", "energy_ledger.csv"}) take(readSeries(kOld / log));
    for (const sim::Renamed& row : sim::renamedFields()) EXPECT_FALSE(columns.contains(std::string(row.before))) << row.before;
    for (const char* now : {"fabric/substep_splits", "fabric/truncated_substeps", "fabric/least_accepted_fraction", "rejected_steps",
                            "energy_ledger/changes/position_correction", "energy_ledger/residual", "hydrostatic_iterations", "ledger/pin_impulse",
                            "ledger/momentum/solid_impulse", "ledger/momentum/support_residual", "fabric/accepted_fraction",
                            "fabric/candidate_list_builds", "fabric/global_scalings", "position_correction_erg", "residual_erg"})
        EXPECT_TRUE(columns.contains(now)) << now;
}

TEST(RenamedFields, OfAReportWrittenBeforeAreRead)
{
    const auto report = readReport(kOld);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->status, "done");
    EXPECT_TRUE(report->stageSeconds[static_cast<int>(sim::Stage::Backup)]);
    EXPECT_FALSE(report->stageSeconds[static_cast<int>(sim::Stage::Rejected)]) << "none was rejected";
}

/// Against the same with one number changed, and with that column left out by its name of before.
TEST(RenamedFields, AreComparedAndIgnoredUnderBothNames)
{
    const test::TemporaryFolder folder;
    std::string ledger = test::contentOf(kOld / "energy_ledger.csv");
    test::writeFile(folder / "a.csv", ledger);
    const std::size_t place = ledger.find("places_erg");
    ASSERT_NE(place, std::string::npos);
    test::writeFile(folder / "b.csv", ledger.replace(place, 10, "position_correction_erg"));
    const auto diff = [&](const char* b, const std::vector<std::string>& sets) {
        return diffResults({folder / "a.csv", folder / b, {}, false}, sets, [] { return false; });
    };
    EXPECT_FALSE(diff("b.csv", {}).differs());
    ledger.replace(ledger.rfind(','), std::string::npos, ",7\n");
    test::writeFile(folder / "c.csv", ledger);
    EXPECT_TRUE(diff("c.csv", {}).differs());
    EXPECT_NE(diff("c.csv", {}).verdict().find("residual_erg"), std::string::npos) << diff("c.csv", {}).verdict();
    for (const char* name : {"unbooked_erg", "residual_erg"}) EXPECT_FALSE(diff("c.csv", {std::string("ignore=[") + name + "]"}).differs()) << name;
}

TEST(RenamedFields, DoNotHinderComparingPlottingAndRepeating)
{
    const test::TemporaryFolder folder;
    EXPECT_FALSE(diffResults({kOld, kOld, {}, false}, {}, [] { return false; }).differs());
    joinEnergies({{"old", "Old", kOld / "energy.csv"}}, folder / "energy.csv");
    EXPECT_EQ(test::linesOf(folder / "energy.csv").size(), test::linesOf(kOld / "energy.csv").size());
    const RunToRepeat run = readRunToRepeat(kOld);
    const sim::Scene scene = sim::readScene(sim::sceneFileFromText(run.request.text.value(), run.request.file));
    EXPECT_EQ(scene.settings.transfer.affineDamping, 0.01);
    EXPECT_EQ(scene.settings.fabricTransfer.stretchDamping, 0.1);
    EXPECT_EQ(scene.settings.transfer.dampingDt, 1.0e-3);
    EXPECT_EQ(scene.settings.coupling.capture.publishedRateFactor, 2.0);
    EXPECT_EQ(std::ranges::count_if(scene.notes, [](const std::string& note) { return note.find(" is called ") != std::string::npos; }), 3);
}

}  // namespace
}  // namespace app
