#include "app/bench.h"
#include "app/gnuplot.h"
#include "app/interrupt.h"
#include "app/lab/case_files.h"
#include "app/lab/converged.h"
#include "app/lab/precision_plot.h"
#include "app/lab/precision_report.h"
#include "app/lab/precision_table.h"
#include "app/output_files.h"
#include "app/output_folder.h"
#include "app/progress.h"
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
    fmt::print("{:<14} {:<11} {:<10} {:<10} {:<10} {:>7} steps {:>9.3f} s  ", row.scene, row.names.method,
               row.names.integrator, row.names.step, row.names.resolution, row.steps, row.wallSeconds);
    if (row.isDone())
        fmt::print("error {:.4g}, energy left {:.4g}\n", row.error, row.energyLeft);
    else
        fmt::print("{}\n", row.outcome);
    std::fflush(stdout);
}

/// All runs of a case that are not in the table, then its rows.
PrecisionCase runCase(const std::string& file, const std::vector<PrecisionRun>& runs, const Options& options,
                      const Parts& parts, const fs::path& folder, PrecisionTable& table)
{
    const auto stopWanted = [] { return interruptsSeen() > 0; };
    const SceneSetup& setup = runs.front().setup;
    PrecisionCase of{runs.front().scene, setup.scene.title, *setup.precision, {}};
    const auto isMissing = [&](const PrecisionRun& run) { return !table.find(run, options.threads, options.repeats); };
    std::vector<std::vector<Reading>> converged;
    if (setup.precision->needsConverged() && std::ranges::any_of(runs, isMissing))
        converged = convergedReadings(folder / (of.name + "_converged.csv"), convergedSetup(file, parts),
                                      options.threads, parts, stopWanted);
    for (const PrecisionRun& run : runs) {
        if (isMissing(run)) {
            const PrecisionRow row =
                measurePrecision(run, converged, options.threads, options.repeats, parts, stopWanted);
            table.add(row);
            tell(row);
        }
        const PrecisionRow* row = table.find(run, options.threads, options.repeats);
        if (row->isDone()) of.rows.push_back(*row);
    }
    return of;
}

}  // namespace

int runVerbBenchPrecision(const Options& options, const Parts& parts)
{
    // All are loaded, and so validated, before the first one starts.
    std::vector<std::pair<std::string, std::vector<PrecisionRun>>> all;
    for (const fs::path& file : caseFiles(fs::path("bench") / "precision", options.cases))
        all.emplace_back(file.string(), precisionRuns(file.string(), parts, options.quick));
    const fs::path folder = folderOf(options);
    makeFolder(folder);
    PrecisionTable table(folder / "precision.csv");
    std::vector<PrecisionCase> cases;
    for (const auto& [file, runs] : all) cases.push_back(runCase(file, runs, options, parts, folder, table));
    if (canPlot()) plotPrecision(cases, folder);
    writeWhole(folder / "report.md", precisionReport(cases, machineOf(options), canPlot()));
    for (const PrecisionCase& of : cases)
        if (const std::string sentence = gainSentence(of); !sentence.empty())
            fmt::print("{}: {}\n", of.title, sentence);
    fmt::print("{}\n", (folder / "report.md").string());
    return 0;
}

}  // namespace app
