#pragma once

#include "app/checkpoint/checkpoint.h"
#include "app/scene/loaded_scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// What the user wants to go on with.
struct ResumeRequest {
    std::filesystem::path folder;           ///< folder of the run
    std::optional<std::int64_t> fromFrame;  ///< nothing: the last checkpoint
    std::vector<std::string> sets;          ///< "dotted.key=value"
    std::filesystem::path out;              ///< empty: go on in the folder itself
};

struct ResumedRun {
    LoadedScene setup;
    Checkpoint checkpoint;
    std::filesystem::path out;
    bool isBranch = false;  ///< whether it goes on in another folder than it began
};

/// Has this very run, by this very program, been stopped or killed with a checkpoint to go on from?
bool canResume(const std::filesystem::path& folder, const std::string& contentHash);

/// Has this run come to its end without a checkpoint, and is nothing asked of it that lies behind its end?
bool isFinished(const ResumeRequest& request);

/// Reads a run's scene and the checkpoint to go on from. In its own folder a run may be given another end and other
/// pictures. In another folder, a branch, all may change that can change during a run: from the next step on, as
/// `changes` of the branch's scene say, so that the branch can be run from the start as well.
/// Throws InputError, having touched nothing.
ResumedRun resumeRun(const ResumeRequest& request, const std::function<LoadedScene(const SceneRequest&)>& load);

}  // namespace app
