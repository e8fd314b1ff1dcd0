#pragma once

#include "app/runs/stored_run.h"

#include <filesystem>
#include <functional>

namespace app {

/// Read the probes of a run from its states, into probes.csv in a folder: as often as both have it, and what states hold. Readings that need the run
/// itself are left out with a warning. True unless it was stopped, in which case nothing is written.
/// Throws InputError where all readings need the run itself.
bool probeStoredRun(const StoredRun& run, const std::filesystem::path& out, const std::function<bool()>& stopWanted);

}  // namespace app
