#include "app/runs/stored_run.h"

#include "app/pictures/frame_sink.h"
#include "app/reports/output_folder.h"
#include "app/reports/run_report.h"
#include "app/system/atomic_files.h"
#include "app/system/progress.h"
#include "sim/core/check.h"

#include <fmt/format.h>

namespace app {

namespace fs = std::filesystem;

StoredRun openStoredRun(const fs::path& folder, const std::vector<std::string>& sets, const Backends& backends)
{
    const fs::path scene = folder / "resolved.yaml";
    if (!fs::exists(scene)) throw sim::InputError(fmt::format("{}: this is no folder of a run: it has no resolved.yaml", folder.string()));
    StoredRun run = {.folder = folder, .setup = backends.loadScene({scene.string(), "", sets}), .kind = StateKind::ForPictures, .frames = {}};
    if (trajectoryHash(run.setup) != trajectoryHash(backends.loadScene({scene.string(), "", {}})))
        throw sim::InputError(fmt::format("--set: {} holds what was simulated; only render and output can be set anew", folder.string()));
    if (const auto report = readReport(folder)) {
        run.setup.variant = report->variant;
        run.setup.label = report->label;
    }
    for (const StateKind kind : {StateKind::ForResuming, StateKind::ForPictures})
        if (auto frames = storedFrames(folder, kind); !frames.empty() && frames.size() >= run.frames.size()) {
            run.kind = kind;
            run.frames = std::move(frames);
        }
    if (run.frames.empty())
        throw sim::InputError(fmt::format("{}: there are no stored states in it; output.data: [states] makes a run store them", folder.string()));
    return run;
}

bool forEachState(const StoredRun& run, const std::function<bool()>& stopWanted, const std::function<void(const Checkpoint&)>& f)
{
    const std::int64_t first = run.frames.front(), last = run.frames.back();
    Progress progress(stderr, run.setup.label, frameTime(run.setup, first), frameTime(run.setup, last), last);
    for (const std::int64_t frame : run.frames) {
        if (stopWanted()) return false;
        const Checkpoint stored = loadCheckpoint(stateFile(run.folder, run.kind, frame));
        f(stored);
        progress.frameDone();
        progress.stepDone(stored.state.time, run.setup.pictures.output.every, 0.0);
    }
    return true;
}

bool drawStoredRun(const StoredRun& run, const fs::path& out, bool asPanel, const Backends& backends, const std::function<bool()>& stopWanted)
{
    const sim::Fabric fabric = sim::assembleFabric(run.setup.scene.fabrics);
    FrameSink sink(run.setup, backends, out, asPanel, run.frames.front() == 0);
    const bool ended = forEachState(
        run, stopWanted, [&](const Checkpoint& stored) { sink.take(stored.state, fabric, nullptr, stored.origin.frame, stored.origin.stateHash); });
    sink.finish();
    return ended;
}

}  // namespace app
