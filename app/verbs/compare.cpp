#include "app/runs/compare.h"

#include "app/reports/output_folder.h"
#include "app/system/interrupt.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

/// Runs that are there already.
int compareFolders(const Options& options, const Backends& backends)
{
    const std::vector<ComparedRun> runs = storedRuns(options.from, options.sets, backends);
    makeFolder(options.out);
    makeComparisonOutputs(runs, {runs.front().setup.pictures, true, options.video, options.out}, backends, stopWanted);
    return stopWanted() ? 1 : 0;
}

}  // namespace

int runVerbCompare(const Options& options, const Backends& backends)
{
    if (!options.from.empty()) return compareFolders(options, backends);
    const SceneSetup asWritten = backends.loadScene({options.scene, "", options.sets});
    if (options.orRun && (asWritten.pictures.compare.variants.empty() || options.variants.size() == 1)) return runVerbRun(options, backends);
    const auto folder = options.out.empty() ? defaultComparisonFolder(asWritten) : options.out;
    const auto runs = comparedRuns(options, backends, folder);
    const bool withFrames = options.frames && asWritten.pictures.output.frames;
    makeFolder(folder);

    const auto done = runAll(runs, options, withFrames, stopWanted);
    if (stopWanted()) return 1;
    if (!done.empty()) makeComparisonOutputs(done, {asWritten.pictures, withFrames, options.video, folder}, backends, stopWanted);
    if (stopWanted()) return 1;
    if (const std::string seen = summarizeRuns(done); !seen.empty()) fmt::print("{}\n", seen);
    if (done.size() == runs.size()) return 0;
    spdlog::error("{} of {} variants did not get to their end", runs.size() - done.size(), runs.size());
    return 1;
}

}  // namespace app
