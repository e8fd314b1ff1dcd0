#pragma once

#include "app/study/study.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

enum class StudyStatus { Waiting, Done, Failed, Interrupted };

/// How a run of a study stands.
struct StudyOutcome {
    StudyStatus status = StudyStatus::Waiting;
    std::string reason;  ///< why it failed: one line
};

/// What a study's runs are made with.
struct StudyPlaces {
    std::filesystem::path folder;      ///< folder of the study; each run has a folder of its name below it
    int threads = 1;                   ///< number of threads of each run
    bool frames = true, video = true;  ///< may pictures be made?

    std::filesystem::path of(const StudyRun& run) const { return folder / "runs" / run.name; }
};

/// How far a run has come, by what is in its folder: done is what this very program did with these very settings.
StudyOutcome outcomeOf(const StudyRun& run, const StudyPlaces& places);

/// The command line of a run: from the start, or from its last checkpoint if it was stopped.
std::vector<std::string> runArguments(const StudyRun& run, const StudyPlaces& places);

/// Do these runs (numbers in the study) here, `width` at a time, each in a process of its own, and those that fail again. Tells how
/// each ends.
void runHere(const Study& study, const std::vector<std::size_t>& runs, const StudyPlaces& places, int width, const std::function<bool()>& stopWanted);

}  // namespace app
