#pragma once

#include "app/backends.h"

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace app {

/// One run of a study.
struct StudyRun {
    std::string name;                                         ///< name of its folder
    std::vector<std::pair<std::string, std::string>> values;  ///< dotted key and value of what this run sets
    SceneRequest request;
    LoadedScene setup;  ///< read in advance, so that no mistake is found hours later
};

/// Runs of one scene with different settings.
struct Study {
    std::string name;
    std::filesystem::path file;
    std::vector<StudyRun> runs;
    int retries = 1;  ///< times that a failed run is tried again

    /// Keys that runs set, in the order of the file.
    std::vector<std::string> parameters() const;
};

/// The keys of a study's file that are words and numbers.
struct StudyFields {
    std::string name, scene, variant;
    int retries = 1;
};

/// The declaration of all its keys; see sim/scene/describe.h.
template <class V>
void visitFields(V& v, StudyFields& s)
{
    v.text("study", s.name, "Name of the study, and of the folder of its results; left out: that of the file");
    v.required("scene", "the file of the scene that is run, relative to the study, like scene: drop.yaml");
    v.text("scene", s.scene, "Its scene, relative to this file");
    v.text("variant", s.variant, "Of the scene; left out: the scene as written");
    v.other("set", "What all runs set: dotted keys and values");
    v.required("runs", "what is tried, like runs: {grid.cell: [0.3, 0.4]}");
    v.other("runs", "Dotted keys with lists of values, of which all combinations are run, or a list of runs");
    v.integer("retries", s.retries, 0, 100, "Times that a failed run is tried again");
}

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
Study readStudy(const std::filesystem::path& file, const std::function<LoadedScene(const SceneRequest&)>& load);

}  // namespace app
