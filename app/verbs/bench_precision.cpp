#include "app/lab/checks/case_files.h"
#include "app/lab/precision/precision_plot.h"
#include "app/lab/precision/precision_report.h"
#include "app/lab/precision/precision_table.h"
#include "app/lab/precision/reference_run.h"
#include "app/lab/timing/bench.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "app/system/interrupt.h"
#include "app/system/progress.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

namespace app {

namespace {

namespace fs = std::filesystem;

/// Where the results go.
fs::path folderOf(const Options& options)
{
    if (!options.out.empty()) return options.out;
    if (options.csv) return machineFolder(options) / "precision";
    return fs::path("out") / (options.quick ? "precision_quick" : "precision");
}

void tell(const PrecisionRow& row)
{
    fmt::print("{:<14} {:<11} {:<10} {:<10} {:<10} {:>7} steps {:>9.3f} s  ", row.scene, row.names.method, row.names.integrator, row.names.step,
               row.names.resolution, row.steps, row.wallSeconds);
    if (row.isDone()) fmt::print("error {:.4g}, energy left {:.4g}\n", row.error, row.energyLeft);
    else fmt::print("{}\n", row.outcome);
    std::fflush(stdout);
}

/// What the table has of a case.
PrecisionCase caseOf(const std::vector<PrecisionRun>& runs, const Options& options, const PrecisionTable& table)
{
    const LoadedScene& setup = runs.front().setup;
    PrecisionCase of{runs.front().scene, setup.scene.title, *readPrecision(setup), {}};
    for (const PrecisionRun& run : runs) {
        const PrecisionRow* row = table.find(run, options.threads, 1);
        if (row && row->isDone()) of.rows.push_back(*row);
    }
    return of;
}

/// The next run that the report's sentences rest on and that was not repeated yet: of the front or the published scheme.
const PrecisionRun* nextToRepeat(const std::vector<PrecisionRun>& runs, const PrecisionCase& of, int repeats)
{
    for (const PrecisionRow& row : of.rows) {
        if (row.repeats >= repeats || !(of.isOnFront(row) || of.isPublished(row))) continue;
        return &*std::ranges::find(runs, row.names, &PrecisionRun::names);
    }
    return nullptr;
}

/// All runs of a case that are not in the table, then its rows.
PrecisionCase runCase(const std::string& file, const std::vector<PrecisionRun>& runs, const Options& options, const Backends& backends,
                      const fs::path& folder, PrecisionTable& table)
{
    const auto isMissing = [&](const PrecisionRun& run) { return !table.find(run, options.threads, 1); };
    PrecisionCase of = caseOf(runs, options, table);
    std::vector<std::vector<Sample>> converged;
    if (of.precision.needsConverged() && (std::ranges::any_of(runs, isMissing) || nextToRepeat(runs, of, options.repeats)))
        converged = convergedReadings(folder / (of.name + "_converged.csv"), convergedSetup(file, backends), options.threads, backends, stopWanted);
    const auto measure = [&](const PrecisionRun& run, int repeats) {
        const PrecisionRow row = measurePrecision(run, converged, options.threads, repeats, backends, stopWanted);
        table.add(row);
        tell(row);
    };
    for (const PrecisionRun& run : runs)
        if (isMissing(run)) measure(run, 1);
    // Other times make another front.
    for (of = caseOf(runs, options, table); const PrecisionRun* run = nextToRepeat(runs, of, options.repeats); of = caseOf(runs, options, table))
        measure(*run, options.repeats);
    return of;
}

}  // namespace

int runVerbBenchPrecision(const Options& options, const Backends& backends)
{
    // All are loaded, and so validated, before the first one starts.
    std::vector<std::pair<std::string, std::vector<PrecisionRun>>> all;
    for (const fs::path& file : caseFiles(fs::path("bench") / "precision", options.cases))
        all.emplace_back(file.string(), precisionRuns(file.string(), backends, options.quick));
    const fs::path folder = folderOf(options);
    makeFolder(folder);
    PrecisionTable table(folder / "precision.csv");
    std::vector<PrecisionCase> cases;
    for (const auto& [file, runs] : all) cases.push_back(runCase(file, runs, options, backends, folder, table));
    if (canPlot()) plotPrecision(cases, folder);
    writeWhole(folder / "report.md", precisionReport(cases, machineOf(options), canPlot()));
    for (const PrecisionCase& of : cases)
        if (const std::string sentence = gainSentence(of); !sentence.empty()) fmt::print("{}: {}\n", of.title, sentence);
    fmt::print("{}\n", (folder / "report.md").string());
    return 0;
}

}  // namespace app
