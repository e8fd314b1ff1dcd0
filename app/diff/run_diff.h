#pragma once

#include "app/diff/finding.h"
#include "app/scene/tolerance.h"

#include <filesystem>
#include <functional>
#include <vector>

namespace app {

/// Two runs by what they have left besides pictures: state hash, states, series, report. What only one of them has differs.
/// Throws InputError where a file cannot be understood, or when stopped.
std::vector<DiffFinding> diffRuns(const std::filesystem::path& a, const std::filesystem::path& b, const Tolerance& tolerance,
                                  const std::function<bool()>& stopWanted);

/// Two states in files.
std::vector<DiffFinding> diffStateFiles(const std::filesystem::path& a, const std::filesystem::path& b, const Tolerance& tolerance);

}  // namespace app
