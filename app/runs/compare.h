#pragma once

#include "app/backends.h"
#include "app/options.h"
#include "app/pictures/side_by_side.h"

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace app {

/// One variant of a comparison: an ordinary run in a folder of its own.
struct ComparedRun {
    LoadedScene setup;
    std::filesystem::path folder;
    std::string contentHash;
    double cost = 1.0;  ///< what it is expected to take, relative to other runs of the same command
};

/// The variants a comparison is about, every one of them loaded and so validated before the first one starts.
/// Throws InputError when the scene has none, or none of a name asked for.
std::vector<ComparedRun> comparedRuns(const Options& options, const Backends& backends, const std::filesystem::path& folder);

/// Runs that are there, each in its folder, to be put side by side; pictures made anew by `render` are as good.
/// @param sets  "dotted.key=value", of render, output and compare
/// Throws InputError for folders without a run or without pictures.
std::vector<ComparedRun> storedRuns(const std::vector<std::filesystem::path>& folders, const std::vector<std::string>& sets,
                                    const Backends& backends);

/// Is this very run, by this very program, already there to its end (with its pictures, if wanted)?
bool isDone(const ComparedRun& run, bool withFrames);

/// The command line of one variant's own process: from the start, or from its last checkpoint if it was stopped.
std::vector<std::string> runArguments(const ComparedRun& run, const Options& options);

/// Run what is not done yet, each in a process of its own, so that its peak memory and its crash are its own. Returns those that got to
/// their end; of a run that was stopped, those before it.
/// @param costAfter  of what follows on them in the same command
std::vector<ComparedRun> runAll(const std::vector<ComparedRun>& runs, const Options& options, bool withFrames, double costAfter,
                                const std::function<bool()>& stopWanted);

/// What those of them cost that are still to be done.
double costOf(std::span<const ComparedRun> runs, const Options& options, bool withFrames);

/// What was seen of runs that are done, in one sentence; "" where they have written no energies.
std::string summarizeRuns(const std::vector<ComparedRun>& runs);

/// Pictures of a run, as they are there.
FrameSequence sequenceOf(const ComparedRun& run);

/// What is to be made of runs that are done.
struct ComparisonOutputs {
    const PictureSettings& pictures;  ///< wishes of the scene about pictures
    bool withFrames, withVideo;       ///< what is made of pictures, too; and videos of them
    std::filesystem::path folder;     ///< where products go
};

/// Table, energy plot with its CSV, contact sheet and side-by-side video of runs that are done, as the scene wishes.
void makeComparisonOutputs(const std::vector<ComparedRun>& runs, const ComparisonOutputs& wanted, const Backends& backends,
                           const std::function<bool()>& stopWanted);

}  // namespace app
