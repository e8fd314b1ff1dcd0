#pragma once

#include "app/lab/precision/precision_cases.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// Error over run time of the cases side by side, as a script for gnuplot: a point per run, a line along the best of
/// each method and integrator, the front of all as a broad line, and circles about the published scheme.
std::string workPrecisionScript(const std::vector<const PrecisionCase*>& cases, const std::string& picture);

/// Numerical viscosity over the time step of the case's first resolution, as a script for gnuplot.
std::string viscosityScript(const PrecisionCase& of, const std::string& picture);

/// work_precision_CASE.png of each, numerical_viscosity.png where it is known, and work_precision.png with the
/// headline's. Throws std::runtime_error.
void plotPrecision(const std::vector<PrecisionCase>& cases, const std::filesystem::path& folder);

}  // namespace app
