#include "app/lab/checks/case_files.h"
#include "app/lab/validation/validation_report.h"
#include "app/reports/output_folder.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "app/system/interrupt.h"
#include "app/system/progress.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

namespace app {

namespace {

LoadedScene loadCase(const std::filesystem::path& file, const Options& options, const Backends& backends)
{
    SceneRequest request{file.string(), "", {}};
    LoadedScene setup = backends.loadScene(request);
    const std::optional<Validation> validation = readValidation(setup);
    if (!validation) throw sim::InputError(fmt::format("{}: has no section validate, which tells what is known of it", file.string()));
    logNotes(setup);
    if (options.quick) request.sets = validation->quick;
    request.sets.insert(request.sets.end(), options.sets.begin(), options.sets.end());
    return request.sets.empty() ? setup : backends.loadScene(request);
}

void tell(const CaseResult& result)
{
    fmt::print("{:<24} {:>8}  {}\n", result.name, formatDuration(result.wallSeconds), result.passes() ? "passes" : "FAILS");
    std::fflush(stdout);
}

}  // namespace

int runVerbValidate(const Options& options, const Backends& backends)
{
    const auto folder = options.out.empty() ? std::filesystem::path("out") / (options.quick ? "validation_quick" : "validation") : options.out;
    // All are loaded, and so validated, before the first one starts.
    std::vector<std::pair<std::string, LoadedScene>> cases;
    for (const auto& file : caseFiles("validation", options.cases)) cases.emplace_back(file.stem().string(), loadCase(file, options, backends));
    makeFolder(folder);
    std::vector<CaseResult> results;
    for (const auto& loaded : cases) {
        results.push_back(withThreads(options.threads, [&] { return runCase(loaded.first, loaded.second, backends, stopWanted); }));
        if (stopWanted()) break;
        tell(results.back());
        writeReadings(results.back(), folder);
    }
    writeWhole(folder / "report.md", validationReport(results, options.quick, canPlot()));
    fmt::print("\n{}\n{}\n", findingsTable(results), (folder / "report.md").string());
    const auto failed = std::ranges::count_if(results, [](const CaseResult& result) { return !result.passes(); });
    if (failed == 0) return 0;
    spdlog::error("{} of {} cases fail", failed, results.size());
    return 1;
}

}  // namespace app
