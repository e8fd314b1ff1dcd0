#pragma once

#include "app/lab/validation/run_case.h"

#include <string>
#include <vector>

namespace app {

/// What is compared with, as tables and plots call it.
const char* knownAs(KnownFrom kind);

/// Numbers of checks that read the same against the same, or at the same time, in their order: they share one panel of a plot.
std::vector<std::vector<std::size_t>> panelsOf(const std::vector<Check>& checks);

/// Script of the plot of a case, of the readings in its table name.csv: a panel for each thing that is read, with what is known of it, the scatter
/// of what was measured, and lines at times that are known.
std::string validationPlotScript(const CaseResult& result, const std::string& picture);

}  // namespace app
