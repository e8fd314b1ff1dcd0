#include "app/run_offline.h"

#include "app/checkpoint/state_files.h"
#include "app/frame_view_from_state.h"
#include "app/output_folder.h"
#include "app/progress.h"

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace app {

namespace {

/// Hands the frames of one run to its pipeline, or does nothing where no pictures are wanted.
class FrameSink {
 public:
    FrameSink(const SceneSetup& setup, const Parts& parts, const RunOptions& options) : setup_(setup)
    {
        if (!options.frames) return;
        placeObstacles_ = parts.meshObstacles(setup);
        std::shared_ptr<FrameSnapshot> start;
        if (options.from && setup.pictures.render.camera.autoFrame) start = snapshotOfStart(parts);
        pipeline_.emplace(
            [&setup, startRenderer = parts.startRenderer, panel = options.asPanel, start] {
                const DrawFrame draw = startRenderer(setup, panel);
                if (start) draw(*start);
                return draw;
            },
            options.out);
    }
    void take(const Steppable& simulation, std::int64_t frame)
    {
        if (!pipeline_) return;
        auto snapshot = pipeline_->borrow();
        snapshot->number = frame;
        fillIn(simulation, *snapshot);
        pipeline_->submit(std::move(snapshot));
    }
    /// Wait until all pictures are files.
    void drain()
    {
        if (pipeline_) pipeline_->drain();
    }
    void finish()
    {
        if (pipeline_) pipeline_->finish();
    }

 private:
    void fillIn(const Steppable& simulation, FrameSnapshot& snapshot) const
    {
        const sim::State& state = simulation.state();
        takeSnapshot(state, simulation.fabric(), simulation.contacts(), setup_.scene.settings.liquid.density,
                     extrasOf(setup_.pictures.render), snapshot);
        placeObstacles_(state.time, snapshot.obstacles);
    }
    /// What places a camera that frames everything.
    std::shared_ptr<FrameSnapshot> snapshotOfStart(const Parts& parts) const
    {
        auto snapshot = std::make_shared<FrameSnapshot>();
        fillIn(*parts.startSimulation(setup_), *snapshot);
        return snapshot;
    }

    const SceneSetup& setup_;
    PlaceObstacles placeObstacles_;
    std::optional<FramePipeline> pipeline_;
};

/// Step up to `until`, logging every step. Throws RunError for a state that cannot be trusted.
void stepUntil(double until, Steppable& simulation, Reports& reports, Progress& progress)
{
    // Steps end on `until` itself but for the rounding of sums.
    constexpr double kRounding = 1.0e-12;
    const sim::State& state = simulation.state();
    while (state.time < until - kRounding * std::max(1.0, std::abs(until))) {
        const auto begin = std::chrono::steady_clock::now();
        const sim::StepReport report = simulation.step(until);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        reports.step(state, report);
        progress.stepDone(state.time, report.dt, seconds.count());
    }
}

/// All frames behind `first`, then what is left of the duration after the last one. True if it came to the end.
bool runFrames(const SceneSetup& setup, const RunOptions& options, std::int64_t first, Steppable& simulation, FrameSink& sink, StateKeeper& keeper,
               Reports& reports)
{
    const auto& time = setup.scene.settings.time;
    const std::int64_t frames = frameCount(setup);
    const double end = time.start + time.duration;
    Progress progress(stderr, setup.label, simulation.state().time, end, frames, first);

    for (std::int64_t frame = first + 1; frame <= frames; ++frame) {
        stepUntil(std::min(frameTime(setup, frame), end), simulation, reports, progress);
        sink.take(simulation, frame);
        keeper.picture(simulation.state(), frame);
        reports.frameDone();
        progress.frameDone();
        const bool isStopped = frame < frames && options.stopWanted();
        if (isStopped || keeper.isDue(frame)) {
            sink.drain();  // what a checkpoint follows on is there
            keeper.checkpoint(simulation.state(), frame, reports.soFar());
        }
        if (isStopped) return false;
    }
    stepUntil(end, simulation, reports, progress);
    progress.show();
    return true;
}

bool goesOnInItsFolder(const RunOptions& options) { return options.from && !options.isBranch; }

/// The logs of a run that begins, or of one that is gone on with, in a folder without anything later.
Reports openReports(const SceneSetup& setup, const RunOptions& options)
{
    if (goesOnInItsFolder(options)) {
        Reports reports(options.out, setup, options.contentHash, options.threads, options.from->origin.logs);
        forgetLaterThan(options.from->origin.frame, options.out);
        return reports;
    }
    claimFolder(options.out, {setup.scene.name, setup.variant});
    return Reports(options.out, setup, options.contentHash, options.threads);
}

std::unique_ptr<Steppable> startOrResume(const SceneSetup& setup, const Parts& parts, const RunOptions& options)
{
    auto simulation = options.from ? parts.resumeSimulation(setup, options.from->state) : parts.startSimulation(setup);
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

RunSummary runOffline(const SceneSetup& setup, const Parts& parts, const RunOptions& options)
{
    // First what the user may have got wrong: earlier results stay until this run can begin.
    const auto simulation = startOrResume(setup, parts, options);
    const std::int64_t first = options.from ? options.from->origin.frame : 0;
    Reports reports = openReports(setup, options);
    try {
        writeWhole(options.out / "resolved.yaml", setup.resolved);
        FrameSink sink(setup, parts, options);
        StateKeeper keeper(options.out, setup, {setup.scene.name, setup.variant, setup.label, trajectoryHash(setup), programHash()});
        if (!goesOnInItsFolder(options)) {
            reports.initial(simulation->state(), simulation->fabric(), simulation->energies());
            sink.take(*simulation, first);
            keeper.picture(simulation->state(), first);
        }
        const bool ended = runFrames(setup, options, first, *simulation, sink, keeper, reports);
        sink.finish();
        reports.finish(ended ? RunStatus::Done : RunStatus::Interrupted, ended ? "" : "stopped by the user",
                       hexDigits(simulation->stateHash()));
    } catch (const std::exception& error) {
        reportFailure(reports, error.what());
        throw;
    }
    return reports.summary();
}

}  // namespace app
