#pragma once

#include "app/backends.h"
#include "app/checkpoint/state_files.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// A run that is over, or under way, with the states it has stored.
struct StoredRun {
    std::filesystem::path folder;
    LoadedScene setup;  ///< scene in it, with what is set for pictures and files
    StateKind kind = StateKind::ForPictures;
    std::vector<std::int64_t> frames;  ///< frames of which there is a state, ascending; at least one
};

/// @param sets  "dotted.key=value", of render and output only: the states stay what they are
/// Throws InputError for a folder without a run, without stored states, and for other settings.
StoredRun openStoredRun(const std::filesystem::path& folder, const std::vector<std::string>& sets, const Backends& backends);

/// All states of a run in order, one after the other. True unless stopWanted said so on the way.
bool forEachState(const StoredRun& run, const std::function<bool()>& stopWanted, const std::function<void(const Checkpoint&)>& f);

/// Make pictures of all states anew, into a folder of their own, as the run's settings say. True unless it was stopped.
bool drawStoredRun(const StoredRun& run, const std::filesystem::path& out, bool asPanel, const Backends& backends,
                   const std::function<bool()>& stopWanted);

}  // namespace app
