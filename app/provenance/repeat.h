#pragma once

#include "app/reports/run_report.h"
#include "app/scene/loaded_scene.h"

#include <filesystem>
#include <string>

namespace app {

/// A run that came to its end, as its report.json alone tells it: enough to do it again.
struct RunToRepeat {
    std::filesystem::path report;
    SceneRequest request;  ///< the scene, resolved
    std::string variant, label;
    std::string stateHash;   ///< hash of its last state
    std::string provenance;  ///< see provenanceOf()
};

/// @param report  a report.json, or the folder that it is in
/// Throws InputError where that is none, is of an older version, or of a run that did not come to its end.
RunToRepeat readRunToRepeat(const std::filesystem::path& report);

/// Is the last state the same?
bool isSame(const RunToRepeat& run, const RunSummary& again);

/// "same: …" or "different: …", with what of program, compiler, machine and libraries is not as it was.
std::string verdictOf(const RunToRepeat& run, const RunSummary& again);

}  // namespace app
