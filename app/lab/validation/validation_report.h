#pragma once

#include "app/lab/validation/run_case.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// One line per check: what was found, what is known, whether it passes. A table for what theory says, one for what was measured.
std::string findingsTable(const std::vector<CaseResult>& results);

/// A paragraph per case: what it shows, after whom, what it cost, its checks and its plot.
std::string validationReport(const std::vector<CaseResult>& results, bool isQuick, bool withPlots);

/// folder/name.csv with all readings, and name.png with a panel per check where there is gnuplot. Throws
/// std::runtime_error.
void writeReadings(const CaseResult& result, const std::filesystem::path& folder);

}  // namespace app
