#pragma once

#include "app/lab/precision/precision_run.h"

namespace app {

/// What the run that others are held against reads of each error: from the file where it has been made before, else
/// run now and left there. Throws InputError at a file that is none of its, RunError.
std::vector<std::vector<Sample>> convergedReadings(const std::filesystem::path& file, const LoadedScene& setup, int threads, const Backends& backends,
                                                   const std::function<bool()>& stopWanted);

}  // namespace app
