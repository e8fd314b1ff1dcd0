#pragma once

#include "app/lab/stability/stability_map.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// What is known of one scene.
struct StabilityResult {
    std::string name;  ///< name of its folder below that of the report
    std::string title;
    StabilityMap map;
    std::vector<StabilityRow> rows;
};

/// folder/map.png: methods against time steps, where there is gnuplot. Throws std::runtime_error.
void plotStabilityMap(const StabilityResult& result);

/// Markdown: what stable means, the largest stable step of each method in each scene, and why which run is not.
std::string stabilityReport(const std::vector<StabilityResult>& results, bool withPlots);

}  // namespace app
