#pragma once

#include "app/parts.h"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace app {

/// One run of a study.
struct StudyRun {
    std::string name;                   ///< of its folder
    std::vector<std::pair<std::string, std::string>> values;  ///< dotted key and value of what this run sets
    SceneRequest request;
    SceneSetup setup;                   ///< read in advance, so that no mistake is found hours later
};

/// Runs of one scene with different settings.
struct Study {
    std::string name;
    std::filesystem::path file;
    std::vector<StudyRun> runs;
    int retries = 1;                    ///< times that a failed run is tried again

    /// Keys that runs set, in the order of the file.
    std::vector<std::string> parameters() const;
};

/// Reads a study's file:
///
///     study: dam_cells                       # its name
///     scene: dam_break_small.yaml            # beside this file
///     variant: best                          # of the scene; may be left out
///     set: {time.duration: 0.1}              # for all runs; may be left out
///     runs: {grid.cell: [0.3, 0.4], transfer.method: [apic, polypic]}   # all combinations, or a list of runs
///     retries: 1
///
/// Throws InputError with file and line, also for a scene that would be refused.
Study readStudy(const std::filesystem::path& file, const std::function<SceneSetup(const SceneRequest&)>& load);

}  // namespace app
