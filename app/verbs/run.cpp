#include "app/checkpoint/state_files.h"
#include "app/pictures/video.h"
#include "app/provenance/repeat.h"
#include "app/runs/resume.h"
#include "app/runs/run_offline.h"
#include "app/system/atomic_files.h"
#include "app/system/interrupt.h"
#include "app/system/progress.h"
#include "app/system/statistics.h"
#include "app/system/thread_limit.h"
#include "app/verbs/verbs.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace app {

namespace {

/// "apic: 250 steps, 0.031 s/step, 7 m 45 s, 412 MB, in out/dam_break_small/apic"
void printOutcome(const RunSummary& summary, const std::filesystem::path& folder)
{
    fmt::print("{}: {} steps, {:.3f} s/step, {}, {:.0f} MB, in {}\n", summary.variant, summary.steps, median(summary.times.total),
               formatDuration(summary.wallSeconds), summary.peakMemoryMegabytes, folder.string());
}

RunOptions runOptions(const Options& options, const LoadedScene& setup)
{
    return {.out = options.out.empty() ? defaultFolder(setup) : options.out,
            .contentHash = contentHash(setup, options.asPanel, programHash()),
            .threads = options.threads,
            .frames = options.frames && setup.pictures.output.frames,
            .asPanel = options.asPanel,
            .runsToFollow = options.runsToFollow,
            .stopWanted = stopWanted};
}

/// A run that fails says where its last good state is, if it has kept one.
RunSummary runReportingKeptState(const LoadedScene& setup, const RunOptions& run, const Backends& backends)
try {
    return runOffline(setup, backends, run);
} catch (const sim::RunError&) {
    if (!storedFrames(run.out, StateKind::ForResuming).empty())
        spdlog::warn("go on from the last good state with other settings: drench run --resume {} --out FOLDER --set key=value", run.out.string());
    throw;
}

/// A run that was done without pictures and is gone on with has none either.
bool hasPictures(const std::filesystem::path& folder) { return !numbersIn(folder, "frame_", ".png").empty(); }

RunSummary runToItsEnd(const LoadedScene& setup, const RunOptions& run, const Options& options, const Backends& backends)
{
    RunSummary summary = withThreads(options.threads, [&] { return runReportingKeptState(setup, run, backends); });
    if (run.frames && options.video && summary.status == RunStatus::Done && hasPictures(run.out)) makeVideo(run.out, setup.pictures.output);
    printOutcome(summary, run.out);
    if (!options.asPanel) fmt::print("{}", stageTable(summary.times));
    if (summary.status != RunStatus::Done)
        spdlog::error("stopped by the user after frame {}; go on with drench run --resume {}", summary.frames, run.out.string());
    return summary;
}

int exitCodeOf(const RunSummary& summary) { return summary.status == RunStatus::Done ? 0 : 1; }

int continueRun(const Options& options, const Backends& backends)
{
    const ResumeRequest request = {options.resume, options.fromFrame, options.sets, options.out};
    if (isFinished(request)) {
        fmt::print("{}: the run is done, and there is nothing left to go on with\n", options.resume.string());
        return 0;
    }
    const ResumedRun resumed = resumeRun(request, backends.loadScene);
    RunOptions run = runOptions(options, resumed.setup);
    run.out = resumed.out;
    run.from = &resumed.checkpoint;
    run.isBranch = resumed.isBranch;
    if (resumed.checkpoint.origin.program != programHash())
        spdlog::warn("{} was begun by another build of this program: what follows may differ in its last digits", options.resume.string());
    return exitCodeOf(runToItsEnd(resumed.setup, run, options, backends));
}

/// Repeats the run of a report, into a folder beside it unless --out says another.
int runAgain(const Options& options, const Backends& backends)
{
    const RunToRepeat repeated = readRunToRepeat(options.again);
    LoadedScene setup = backends.loadScene(repeated.request);
    setup.variant = repeated.variant;
    setup.label = repeated.label;
    RunOptions run = runOptions(options, setup);
    if (options.out.empty()) run.out = repeated.report.parent_path() / "again";
    if (std::filesystem::weakly_canonical(run.out) == std::filesystem::weakly_canonical(repeated.report).parent_path())
        throw sim::InputError(fmt::format("--out {}: there are the results of the run itself; choose another folder", run.out.string()));
    const RunSummary again = runToItsEnd(setup, run, options, backends);
    if (again.status != RunStatus::Done) throw sim::InputError("stopped before the run could be compared");
    fmt::print("{}\n", verdictOf(repeated, again));
    return isSame(repeated, again) ? 0 : 1;
}

}  // namespace

int runVerbRun(const Options& options, const Backends& backends)
{
    if (!options.resume.empty()) return continueRun(options, backends);
    if (!options.again.empty()) return runAgain(options, backends);
    const LoadedScene setup = backends.loadScene(options.request());
    logNotes(setup);
    return exitCodeOf(runToItsEnd(setup, runOptions(options, setup), options, backends));
}

}  // namespace app
