#include "app/compare.h"

#include "app/child_process.h"
#include "app/interrupt.h"
#include "app/output_folder.h"
#include "app/verbs/verbs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>

namespace app {

namespace {

bool stopWanted()
{
    return interruptsSeen() > 0;
}

/// Run one variant as a process of its own, so that its peak memory and its crash are its own. True if it got to its
/// end.
bool runVariant(const ComparedRun& run, const Options& options, std::size_t number, std::size_t count)
{
    fmt::print("[{}/{}] {}\n", number, count, run.setup.label);
    std::fflush(stdout);
    const ChildExit end = runChild("/proc/self/exe", runArguments(run, options), {.folder = {}, .quiet = false});
    return end.ok();
}

}  // namespace

int runVerbCompare(const Options& options, const Parts& parts)
{
    const SceneSetup asWritten = parts.loadScene({options.scene, "", options.sets});
    if (options.orRun && (asWritten.pictures.compare.variants.empty() || options.variants.size() == 1))
        return runVerbRun(options, parts);
    const auto folder = options.out.empty() ? defaultComparisonFolder(asWritten) : options.out;
    const auto runs = comparedRuns(options, parts, folder);
    const bool withFrames = options.frames && asWritten.pictures.output.frames;
    makeFolder(folder);

    std::vector<ComparedRun> done;
    for (const auto& run : runs) {
        if (!options.force && isDone(run, withFrames))
            fmt::print("[{}/{}] {}: already there, in {}\n", done.size() + 1, runs.size(), run.setup.label,
                       run.folder.string());
        else if (!runVariant(run, options, done.size() + 1, runs.size())) {
            if (stopWanted()) return 1;
            continue;
        }
        done.push_back(run);
    }
    if (!done.empty()) makeProducts(done, asWritten.pictures, parts, withFrames, options.video, folder, stopWanted);
    if (stopWanted()) return 1;
    if (done.size() == runs.size()) return 0;
    spdlog::error("{} of {} variants did not get to their end", runs.size() - done.size(), runs.size());
    return 1;
}

}  // namespace app
