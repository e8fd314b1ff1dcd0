#pragma once

#include "app/backends.h"
#include "app/checkpoint/checkpoint.h"
#include "app/reports/run_report.h"

#include <filesystem>
#include <functional>

namespace app {

struct RunOptions {
    std::filesystem::path out;  ///< folder of the run
    std::string contentHash;
    int threads = 1;                                          ///< as limited by the caller; written into the report
    bool frames = true;                                       ///< draw pictures
    bool asPanel = false;                                     ///< pictures are to stand beside others
    double runsToFollow = 0.0;                                ///< what follows in the same command takes so many times as long
    const Checkpoint* from = nullptr;                         ///< state to resume from instead of the start, or null
    bool isBranch = false;                                    ///< the resumed run has a folder of its own, which begins with that state
    std::function<bool()> stopWanted = [] { return false; };  ///< looked at after every frame
};

/// Run a scene to its end without a window: step, draw, write; a run that is stopped leaves a checkpoint. Returns what report.json says at the end:
/// done or interrupted. What goes wrong is thrown after report.json says "failed" and why; frames before it are kept.
RunSummary runOffline(const LoadedScene& setup, const Backends& backends, const RunOptions& options);

}  // namespace app
