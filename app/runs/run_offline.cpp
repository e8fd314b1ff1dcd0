#include "app/runs/run_offline.h"

#include "app/checkpoint/state_files.h"
#include "app/export/geometry_files.h"
#include "app/export/geometry_sink.h"
#include "app/pictures/frame_sink.h"
#include "app/provenance/provenance.h"
#include "app/reports/blocked_sources.h"
#include "app/reports/output_folder.h"
#include "app/system/gnuplot.h"
#include "app/system/progress.h"
#include "sim/core/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace app {

namespace {

/// What a run leaves of its frames, as far as it is wanted: pictures, geometry and states.
class Frames {
 public:
    Frames(const LoadedScene& setup, const Backends& backends, const RunOptions& options, const std::string& provenance)
        : geometry_(setup, backends, options.out, provenance),
          states_(options.out, setup, {setup.scene.name, setup.variant, setup.label, trajectoryHash(setup), programHash(), provenance})
    {
        if (options.frames) pictures_.emplace(setup, backends, options.out, options.asPanel, options.from == nullptr);
    }
    void take(const SimulationHandle& simulation, std::int64_t frame)
    {
        const std::uint64_t hash = simulation.stateHash();
        if (pictures_) pictures_->take(simulation.state(), simulation.fabric(), simulation.contacts(), frame, hash);
        geometry_.take(simulation.state(), simulation.fabric(), frame);
        states_.picture(simulation.state(), frame, hash);
    }
    /// If it is time for one, or the run will not go on.
    void checkpoint(const SimulationHandle& simulation, std::int64_t frame, bool isStopped, const Reports& reports)
    {
        if (!isStopped && !states_.isDue(frame)) return;
        if (pictures_) pictures_->drain();  // what a checkpoint follows on is there
        states_.checkpoint(simulation.state(), frame, simulation.stateHash(), reports.soFar());
    }
    /// The run has failed after this state, which is a good one. Whatever prevents to keep it, the failure is what counts.
    void saveLastValidState(const SimulationHandle& simulation, std::int64_t frame, const Reports& reports)
    try {
        if (pictures_) pictures_->drain();
        states_.checkpoint(simulation.state(), frame, simulation.stateHash(), reports.soFar());
    } catch (const std::exception&) {
    }
    void finish()
    {
        if (pictures_) pictures_->finish();
    }

 private:
    std::optional<FrameSink> pictures_;
    GeometrySink geometry_;
    StateWriter states_;
};

/// Step up to `until`, logging every step. Throws RunError for a state that cannot be trusted.
void stepUntil(double until, SimulationHandle& simulation, Reports& reports, Progress& progress, BlockedSources& shut)
{
    // Steps end on `until` itself but for the rounding of sums.
    constexpr double kRounding = 1.0e-12;
    const sim::State& state = simulation.state();
    while (state.time < until - kRounding * std::max(1.0, std::abs(until))) {
        const auto begin = std::chrono::steady_clock::now();
        const sim::StepReport report = simulation.step(until);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        reports.step(simulation, report);
        shut.look(state);
        progress.stepDone(state.time, report.dt, seconds.count());
    }
}

/// All frames behind `first`, then what is left of the duration after the last one. True if it came to the end.
bool runFrames(const LoadedScene& setup, const RunOptions& options, std::int64_t first, SimulationHandle& simulation, Frames& kept, Reports& reports)
{
    const auto& time = setup.scene.settings.time;
    const std::int64_t frames = frameCount(setup);
    const double end = time.start + time.duration;
    BlockedSources shut(setup.scene);
    Progress progress(stderr, setup.label, simulation.state().time, end, frames, first);
    progress.setRunsToFollow(options.runsToFollow);

    for (std::int64_t frame = first + 1; frame <= frames; ++frame) {
        stepUntil(std::min(frameTime(setup, frame), end), simulation, reports, progress, shut);
        kept.take(simulation, frame);
        reports.frameDone();
        progress.frameDone();
        const bool isStopped = frame < frames && options.stopWanted();
        kept.checkpoint(simulation, frame, isStopped, reports);
        if (isStopped) return false;
    }
    stepUntil(end, simulation, reports, progress, shut);
    progress.show();
    return true;
}

/// runFrames; of a run that fails in a mode that takes bad steps back, the last good state is kept.
bool runFramesOrKeepState(const LoadedScene& setup, const RunOptions& options, std::int64_t first, SimulationHandle& simulation, Frames& kept,
                          Reports& reports)
try {
    return runFrames(setup, options, first, simulation, kept, reports);
} catch (const sim::RunError&) {
    if (setup.scene.settings.time.mode == sim::TimeMode::Adaptive)
        kept.saveLastValidState(simulation, lastFrameUpTo(setup, simulation.state().time), reports);
    throw;
}

bool resumesInPlace(const RunOptions& options) { return options.from && !options.isBranch; }

/// The logs of a run that begins, or of one that is gone on with, in a folder without anything later.
Reports openReports(const LoadedScene& setup, const RunOptions& options, const std::string& provenance)
{
    if (resumesInPlace(options)) {
        Reports reports(options.out, setup, options.contentHash, provenance, options.from->origin.logs, options.from->state.time);
        removeFramesAfter(options.from->origin.frame, options.out);
        removeGeometryAfter(options.from->origin.frame, options.out);
        return reports;
    }
    claimFolder(options.out, {setup.scene.name, setup.variant});
    removeGeometryAfter(-1, options.out);
    return Reports(options.out, setup, options.contentHash, provenance);
}

std::unique_ptr<SimulationHandle> startOrResume(const LoadedScene& setup, const Backends& backends, const RunOptions& options)
{
    auto simulation = options.from ? backends.resumeSimulation(setup, options.from->state) : backends.startSimulation(setup);
    if (setup.pictures.output.ledger) simulation->bookEnergy();
    return simulation;
}

/// The report may fail for the same reason as the run, say a full disk; the run's reason is the one to tell.
void reportFailure(Reports& reports, const std::string& reason)
try {
    reports.finish(RunStatus::Failed, reason, "");
} catch (const std::exception&) {
}

}  // namespace

RunSummary runOffline(const LoadedScene& setup, const Backends& backends, const RunOptions& options)
{
    // First what the user may have got wrong: earlier results stay until this run can begin.
    const auto simulation = startOrResume(setup, backends, options);
    const std::int64_t first = options.from ? options.from->origin.frame : 0;
    const std::string provenance =
        provenanceOf(setup, options.threads, options.frames ? backends.drawnBy() : "", options.from ? options.from->origin.provenance : "");
    Reports reports = openReports(setup, options, provenance);
    try {
        writeWhole(options.out / "resolved.yaml", setup.resolved);
        Frames kept(setup, backends, options, provenance);
        if (!resumesInPlace(options)) {
            reports.initial(*simulation);
            kept.take(*simulation, first);
        }
        const bool ended = runFramesOrKeepState(setup, options, first, *simulation, kept, reports);
        kept.finish();
        reports.finish(ended ? RunStatus::Done : RunStatus::Interrupted, ended ? "" : "stopped by the user", hexDigits(simulation->stateHash()));
    } catch (const std::exception& error) {
        reportFailure(reports, error.what());
        throw;
    }
    if (const auto probes = readProbes(setup); probes && canPlot()) plotProbes(*probes, setup.scene.title, options.out);
    return reports.summary();
}

}  // namespace app
