#include "app/runs/resume.h"

#include "app/checkpoint/state_files.h"
#include "app/scene/changed_scene.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace app {

namespace {

namespace fs = std::filesystem;

std::int64_t checkpointFrame(const ResumeRequest& request)
{
    const std::vector<std::int64_t> frames = storedFrames(request.folder, StateKind::ForResuming);
    if (frames.empty())
        throw sim::InputError(
            fmt::format("--resume {}: there is no checkpoint in it; output.data: [checkpoint] makes a run keep some", request.folder.string()));
    if (!request.fromFrame) return frames.back();
    if (std::ranges::find(frames, *request.fromFrame) == frames.end())
        throw sim::InputError(
            fmt::format("--from-frame {}: there is no checkpoint of this frame; there are those of {}", *request.fromFrame, fmt::join(frames, ", ")));
    return *request.fromFrame;
}

/// Says nothing about how the state goes on.
bool isRunSetting(const std::string& set)
{
    return set.starts_with("time.duration=") || set.starts_with("render.") || set.starts_with("output.") || set.starts_with("compare.");
}

/// The scene as it stands in the folder, with what may be set for a run that goes on.
LoadedScene load(const fs::path& scene, const std::vector<std::string>& sets, std::int64_t step, const ChangedScene::Load& loadScene)
{
    SceneRequest request = {.file = scene.string(), .variant = "", .sets = {}};
    std::vector<std::string> changed;
    for (const std::string& set : sets) (isRunSetting(set) ? request.sets : changed).push_back(set);
    if (changed.empty()) return loadScene(request);
    ChangedScene settings(request, loadScene);
    settings.change(changed, step);
    const std::vector<std::string> waiting = settings.scene(step).waiting;
    if (!waiting.empty()) throw sim::InputError(fmt::format("--set {}: this holds for a whole run; run the scene anew with it", waiting.front()));
    return settings.setup();
}

void requireSameScene(const LoadedScene& setup, const Checkpoint& checkpoint, const fs::path& folder)
{
    if (trajectoryHash(setup) != checkpoint.origin.trajectory)
        throw sim::InputError(
            fmt::format("--resume {}: its checkpoint is not of the scene in its resolved.yaml, or of another version of it or of this program; run "
                        "the scene anew",
                        folder.string()));
}

}  // namespace

bool canResume(const fs::path& folder, const std::string& contentHash)
{
    const auto report = readReport(folder);
    return report && report->contentHash == contentHash && report->status != "done" && report->status != "failed" &&
           !storedFrames(folder, StateKind::ForResuming).empty();
}

bool isFinished(const ResumeRequest& request)
{
    const auto setsAnEnd = [](const std::string& set) { return set.starts_with("time.duration="); };
    const bool asksForMore =
        request.fromFrame || !request.out.empty() || std::ranges::any_of(request.sets, setsAnEnd) || !std::ranges::all_of(request.sets, isRunSetting);
    if (asksForMore || !fs::exists(request.folder / "resolved.yaml")) return false;
    const auto report = readReport(request.folder);
    return report && report->status == "done" && storedFrames(request.folder, StateKind::ForResuming).empty();
}

ResumedRun resumeRun(const ResumeRequest& request, const std::function<LoadedScene(const SceneRequest&)>& loadScene)
{
    const fs::path scene = request.folder / "resolved.yaml";
    if (!fs::exists(scene))
        throw sim::InputError(fmt::format("--resume {}: this is no folder of a run: it has no resolved.yaml", request.folder.string()));
    ResumedRun run;
    run.checkpoint = loadCheckpoint(stateFile(request.folder, StateKind::ForResuming, checkpointFrame(request)));
    const CheckpointOrigin& origin = run.checkpoint.origin;
    requireSameScene(load(scene, {}, 0, loadScene), run.checkpoint, request.folder);
    run.setup = load(scene, request.sets, run.checkpoint.state.step, loadScene);
    run.setup.variant = origin.variant;
    run.setup.label = origin.label;
    run.isBranch = !request.out.empty() && fs::weakly_canonical(request.out) != fs::weakly_canonical(request.folder);
    run.out = run.isBranch ? request.out : request.folder;
    if (!run.isBranch && trajectoryHash(run.setup) != origin.trajectory)
        throw sim::InputError(
            fmt::format("--set: with these settings the run would no longer be the one in {}; go on elsewhere with --out", request.folder.string()));
    if (frameCount(run.setup) < origin.frame)
        throw sim::InputError(fmt::format("--set time.duration: the run would end before its checkpoint at {:.6g} s", run.checkpoint.state.time));
    return run;
}

}  // namespace app
