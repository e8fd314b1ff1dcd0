#pragma once

#include "app/backends.h"
#include "app/lab/precision/precision_row.h"

#include <functional>
#include <string>
#include <vector>

namespace app {

/// One combination of a case's choices.
struct PrecisionRun {
    std::string scene;  ///< the case
    PrecisionNames names;
    LoadedScene setup;
    std::string settings;  ///< PrecisionRow::settings
};

/// 16 digits for what the outcome depends on, beside the program.
std::string settingsOf(const LoadedScene& setup);

/// All combinations of the scene's choices. Throws InputError, also where it has no section precision.
/// @param isQuick  only those that its part `quick` names
std::vector<PrecisionRun> precisionRuns(const std::string& file, const Backends& backends, bool isQuick);

/// The run that others are held against.
LoadedScene convergedSetup(const std::string& file, const Backends& backends);

/// What a run reads for each of the errors, to its end. Throws RunError.
std::vector<std::vector<Sample>> readErrors(const LoadedScene& setup, const Backends& backends, const std::function<bool()>& stopWanted);

/// Run it so many times. What keeps a run from its end stands in the row; a wish to stop is thrown as RunError.
/// @param converged  readings of the run to compare with, of each of the errors; empty where all is known
PrecisionRow measurePrecision(const PrecisionRun& run, const std::vector<std::vector<Sample>>& converged, int threads, int repeats,
                              const Backends& backends, const std::function<bool()>& stopWanted);

}  // namespace app
