#include "app/ensemble/band_plot.h"

#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAlongLine = " at ";  ///< text between a probe's name and where along its line, as Probes::columns() has it

/// Numbers between 1 and 1000 on the axis of energies: a multiple of three.
int energyScale(const std::vector<BandCurve>& curves)
{
    double largest = 0.0;
    for (const BandCurve& curve : curves)
        if (const Band* total = curve.bands.find("total_erg"))
            for (const Spread& at : total->at) largest = std::max({largest, std::abs(at.lowest), std::abs(at.highest)});
    return largest > 0.0 && std::isfinite(largest) ? 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0)) : 0;
}

std::vector<BandPanel> energyPanels(const std::vector<BandCurve>& curves)
{
    const int power = energyScale(curves);
    const double scale = std::pow(10.0, power);
    const std::string unit = power == 0 ? "erg" : fmt::format("10^{} erg", power);
    return {{"kinetic", unit, {"moving_erg"}, scale}, {"potential", unit, {"potential_erg"}, scale}, {"total", unit, {"total_erg"}, scale}};
}

/// "wetness at 2.5 cm [-]" → "wetness", "-", and where: 2.5; without a place for a probe that is read once.
struct ProbeColumn {
    std::string name, unit;
    double at = -1.0;  ///< along its line [cm]; negative: there is none
};
ProbeColumn probeColumn(const std::string& column)
{
    const std::size_t bracket = column.rfind(" ["), at = column.rfind(kAlongLine, bracket);
    ProbeColumn probe = {.name = column.substr(0, bracket), .unit = bracket == std::string::npos ? "" : column.substr(bracket + 2)};
    if (!probe.unit.empty()) probe.unit.pop_back();
    if (at == std::string::npos || bracket == std::string::npos || column.substr(bracket - 3, 3) != " cm") return probe;
    probe.at = std::strtod(column.c_str() + at + std::string(kAlongLine).size(), nullptr);
    probe.name = column.substr(0, at);
    return probe;
}

std::vector<BandPanel> probePanels(const Bands& bands)
{
    std::vector<BandPanel> panels;
    double before = -1.0;
    for (const Band& band : bands.all) {
        const ProbeColumn probe = probeColumn(band.column);
        const bool goesOn = probe.at > before && before >= 0.0 && panels.back().title == probe.name;
        if (!goesOn) panels.push_back({probe.name, probe.unit, {}});
        panels.back().columns.push_back(band.column);
        before = probe.at;
    }
    return panels;
}

/// Range, deviation and mean of one ensemble, from a file or a block whose columns from `mean` on are mean, deviation, lowest and highest.
std::string bandLines(const std::string& data, std::size_t mean, double scale, std::size_t number, const std::string& label)
{
    const std::string_view color = kPlotColors[(number + 1) % kPlotColors.size()];  // without black, which hides its own bands
    const auto value = [&](const std::string& expression) { return fmt::format("(({})*{:.9g})", expression, 1.0 / scale); };
    const std::string m = fmt::format("${}", mean), d = fmt::format("${}", mean + 1);
    std::string text = fmt::format("{} using 1:{}:{} with filledcurves fc rgb '{}' fs transparent solid 0.15 noborder notitle", data,
                                   value(fmt::format("${}", mean + 2)), value(fmt::format("${}", mean + 3)), color);
    text += fmt::format(", \\\n    {} using 1:{}:{} with filledcurves fc rgb '{}' fs transparent solid 0.3 noborder notitle", data,
                        value(m + '-' + d), value(m + '+' + d), color);
    return text + fmt::format(", \\\n    {} using 1:{} with lines lw 2 lc rgb '{}' dt {} title {} noenhanced", data, value(m), color,
                              number % 2 == 0 ? "1" : "(8,4)", gnuplotText(label));  // dashes show what lies below them
}

bool hasValues(const Bands& bands, const std::string& column)
{
    const Band* band = bands.find(column);
    return band && std::ranges::any_of(band->at, [](const Spread& at) { return at.count > 0; });
}

/// Readings along a line at the end, as a block of gnuplot's: where, mean, deviation, lowest, highest.
std::string profileBlock(const Bands& bands, const BandPanel& panel, const std::string& name)
{
    std::string block = fmt::format("{} << END\n", name);
    for (const std::string& column : panel.columns)
        if (const Band* band = bands.find(column); band && band->at.back().count > 0) {
            const Spread& at = band->at.back();
            block += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", probeColumn(column).at, at.mean, at.deviation, at.lowest, at.highest);
        }
    return block + "END\n";
}

std::string panelText(const std::vector<BandCurve>& curves, const BandPanel& panel, std::size_t number, const fs::path& folder)
{
    const bool isProfile = panel.columns.size() > 1;
    std::string blocks;
    std::vector<std::string> lines;
    for (std::size_t n = 0; n < curves.size(); ++n) {
        const std::string block = fmt::format("$profile_{}_{}", number, n);
        const bool isThere = std::ranges::any_of(panel.columns, [&](const std::string& column) {
            return isProfile ? curves[n].bands.find(column) && curves[n].bands.find(column)->at.back().count > 0 : hasValues(curves[n].bands, column);
        });
        if (!isThere) continue;
        if (isProfile) blocks += profileBlock(curves[n].bands, panel, block);
        const std::string file = gnuplotText(fs::relative(curves[n].table, folder).generic_string()) + " skip 1";
        lines.push_back(bandLines(isProfile ? block : file, isProfile ? 2 : placeOfMean(curves[n].bands, panel.columns.front()), panel.scale, n,
                                  curves[n].label));
    }
    const std::string title = isProfile ? panel.title + ", at the end" : panel.title;
    const std::string head = fmt::format("{}set title {} noenhanced\nset ylabel {}\nset xlabel '{}'\n", blocks, gnuplotText(title),
                                         gnuplotUnit(panel.unit), isProfile ? "along the line [cm]" : "time [s]");
    // gnuplot refuses a plot without a point.
    if (lines.empty()) return head + "plot [0:1] [0:1] -1 title 'no value'\n";
    return head + fmt::format("plot {}\nunset key\nunset label 1\n", fmt::join(lines, ", \\\n    "));
}

/// What all panels have in common.
std::string plotHead(std::size_t columns, std::size_t rows, const std::string& title, const std::string& picture)
{
    constexpr double kPanelWidth = 550.0, kPanelHeight = 400.0, kAround = 150.0;  // [pixels]; around: title, key and what bands are
    const double width = kPanelWidth * static_cast<double>(columns), height = kPanelHeight * static_cast<double>(rows) + kAround;
    return fmt::format(
        "set terminal pngcairo size {:.0f},{:.0f} font 'DejaVu Sans,12' linewidth 1\nset output {}\nset datafile separator ','\n"
        "set multiplot layout {},{} margins screen {:.4f},{:.4f},{:.4f},{:.4f} spacing screen {:.4f},{:.4f} title {} noenhanced font ',14'\n"
        "set border 3 lw 1\nset tics nomirror out scale 0.6\nset grid ytics lc rgb '#dddddd' lw 1\nset xrange [*:*] noextend\n"
        "set key at screen 0.5,{:.4f} center center vertical maxrows 2 samplen 2\n"
        "set label 1 'mean; dark band: ± one standard deviation; light band: all runs' at screen 0.5,{:.4f} center font ',9' textcolor rgb "
        "'#555555'\n",
        width, height, gnuplotText(picture), rows, columns, 125.0 / width, 1.0 - 25.0 / width, 140.0 / height, 1.0 - 70.0 / height, 145.0 / width,
        90.0 / height, gnuplotText(title), 48.0 / height, 12.0 / height);
}

}  // namespace

std::vector<BandPanel> panelsOf(const std::vector<BandCurve>& curves)
{
    return curves.front().bands.log == "energy" ? energyPanels(curves) : probePanels(curves.front().bands);
}

std::vector<BandPanel> perParticlePanels()
{
    return {{"kinetic + potential + elastic", "erg per particle", {"per_particle_erg"}},
            {"as published (no motion of the liquid)", "erg per particle", {"published_per_particle_erg"}},
            {"total, less that of the first method", "% of the largest total", {kLessTheFirst}}};
}

void drawBands(const std::vector<BandCurve>& curves, const std::vector<BandPanel>& panels, const std::string& title, const fs::path& folder,
               const std::string& name)
{
    constexpr std::size_t kMostColumns = 3;
    const std::size_t columns = std::min(panels.size(), kMostColumns), rows = (panels.size() + columns - 1) / columns;
    drawPlot(folder, name, [&](const std::string& picture) {
        std::string text = plotHead(columns, rows, title, picture);
        for (std::size_t n = 0; n < panels.size(); ++n) text += panelText(curves, panels[n], n, folder);
        return text + "unset multiplot\n";
    });
}

}  // namespace app
