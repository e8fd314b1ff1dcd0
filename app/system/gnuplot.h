#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace app {

/// Colours that colour-blind readers can tell apart (Okabe and Ito 2008), darkest contrasts first.
inline constexpr std::array<std::string_view, 7> kPlotColors = {"#000000", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// Is there a gnuplot?
bool canPlot();

/// Text between single quotes for gnuplot.
std::string gnuplotText(std::string text);

/// A unit in brackets for an axis, with raised exponents: '[dyn/cm^{2}]' of dyn/cm^2.
std::string gnuplotUnit(const std::string& unit);

/// Draw folder/name.png by the script for a picture of that name, run in the folder, and leave the script beside it as
/// name.gp, to draw it anew with. Throws std::runtime_error with gnuplot's own words.
void drawPlot(const std::filesystem::path& folder, const std::string& name, const std::function<std::string(const std::string& picture)>& script);

}  // namespace app
