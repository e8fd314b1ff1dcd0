#pragma once

#include "app/ensemble/bands.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// An ensemble as a plot shows it.
struct BandCurve {
    std::string label;
    Bands bands;
    std::filesystem::path table;  ///< file with bandsText of the bands
};

/// A part of a plot.
struct BandPanel {
    std::string title, unit;           ///< title and unit of the values
    std::vector<std::string> columns;  ///< one: over time; several: readings along a line, as they are at the end
    double scale = 1.0;                ///< values are told in so many units
};

/// Panels of the log that the curves are of: kinetic, potential and total energy, or one for each probe.
std::vector<BandPanel> panelsOf(const std::vector<BandCurve>& curves);

/// Energy per particle as the paper draws it, beside it what the published program takes for it, and what totals are less that of the first method.
std::vector<BandPanel> perParticlePanels();

/// Draw folder/name.png, with folder/name.gp beside it: of each ensemble the mean, a dark band as wide as the standard deviation to both sides, and a
/// light one from the lowest to the highest of all runs. Throws std::runtime_error with gnuplot's own words.
void drawBands(const std::vector<BandCurve>& curves, const std::vector<BandPanel>& panels, const std::string& title,
               const std::filesystem::path& folder, const std::string& name);

}  // namespace app
