#include "app/run_offline.h"

#include "app/export/geometry_sink.h"
#include "app/frame_view_from_state.h"
#include "app/output_folder.h"
#include "app/progress.h"

#include <chrono>
#include <cmath>
#include <optional>

namespace app {

namespace {

/// Hands the frames of one run to its pictures and its geometry, where these are wanted.
class FrameSink {
 public:
    FrameSink(const SceneSetup& setup, const Parts& parts, const RunOptions& options)
        : setup_(setup), geometry_(setup, parts, options.out)
    {
        if (!options.frames) return;
        placeObstacles_ = parts.meshObstacles(setup);
        pipeline_.emplace([&setup, start = parts.startRenderer, panel = options.asPanel] { return start(setup, panel); },
                          options.out);
    }
    void take(const Steppable& simulation, std::int64_t frame)
    {
        const sim::State& state = simulation.state();
        geometry_.take(state, simulation.fabric(), frame);
        if (!pipeline_) return;
        auto snapshot = pipeline_->borrow();
        snapshot->number = frame;
        takeSnapshot(state, simulation.fabric(), simulation.contacts(), setup_.scene.settings.liquid.density,
                     extrasOf(setup_.pictures.render), *snapshot);
        placeObstacles_(state.time, snapshot->obstacles);
        pipeline_->submit(std::move(snapshot));
    }
    void finish()
    {
        if (pipeline_) pipeline_->finish();
    }

 private:
    const SceneSetup& setup_;
    GeometrySink geometry_;
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

/// All frames, then what is left of the duration after the last one. True if it came to the end.
bool runFrames(const SceneSetup& setup, const RunOptions& options, Steppable& simulation, FrameSink& sink, Reports& reports)
{
    const auto& time = setup.scene.settings.time;
    const std::int64_t frames = frameCount(setup);
    const double end = time.start + time.duration;
    Progress progress(stderr, setup.label, time.start, end, frames);

    sink.take(simulation, 0);
    for (std::int64_t frame = 1; frame <= frames; ++frame) {
        stepUntil(std::min(frameTime(setup, frame), end), simulation, reports, progress);
        sink.take(simulation, frame);
        reports.frameDone();
        progress.frameDone();
        if (frame < frames && options.stopWanted()) return false;
    }
    stepUntil(end, simulation, reports, progress);
    progress.show();
    return true;
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
    const auto simulation = parts.startSimulation(setup);
    if (setup.pictures.output.ledger) simulation->bookEnergy();
    claimFolder(options.out, {setup.scene.name, setup.variant});
    Reports reports(options.out, setup, options.contentHash, options.threads);
    try {
        writeWhole(options.out / "resolved.yaml", setup.resolved);
        reports.initial(simulation->state(), simulation->fabric(), simulation->energies());
        FrameSink sink(setup, parts, options);
        const bool ended = runFrames(setup, options, *simulation, sink, reports);
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
