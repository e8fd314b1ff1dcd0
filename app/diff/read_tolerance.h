#pragma once

#include "app/scene/tolerance.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// The file that goes with pictures, in their folder.
inline constexpr const char* kToleranceFile = "tolerance.yaml";

/// The keys of `compare.tolerance` from a scene, or from a file that has nothing but them. A file that is not given leaves
/// everything at its default.
/// @param isRun  the file is the resolved.yaml of a run, and a scene whatever stands in it
/// @param sets   "key=value", over what the file says
/// Throws InputError at the line of what is wrong.
Tolerance readTolerance(const std::filesystem::path& file, bool isRun, const std::vector<std::string>& sets);

}  // namespace app
