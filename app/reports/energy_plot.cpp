#include "app/reports/energy_plot.h"

#include "app/reports/step_logs.h"
#include "app/system/atomic_files.h"
#include "app/system/csv.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace app {

namespace {

/// The largest total energy in a file, by size [erg]; 0 if there is none.
double largestEnergy(const std::filesystem::path& csv)
{
    constexpr int kTotalColumn = 4;
    std::istringstream in(readWhole(csv));
    std::string line;
    double largest = 0.0;
    for (std::getline(in, line); std::getline(in, line);) {
        std::istringstream cells(line);
        std::string cell;
        for (int column = 0; column <= kTotalColumn; ++column) std::getline(cells, cell, ',');
        if (const double value = std::strtod(cell.c_str(), nullptr); std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
    return largest;
}

/// Axis numbers between 1 and 1000: a multiple of three.
int axisScale(const std::vector<EnergyCurve>& curves)
{
    double largest = 0.0;
    for (const auto& curve : curves) largest = std::max(largest, largestEnergy(curve.csv));
    return largest > 0.0 ? 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0)) : 0;
}

/// How a curve is drawn; dashes show what lies below them.
std::string look(std::size_t curve, const std::string& label)
{
    return fmt::format("with lines lw 2 lc rgb '{}' dt {} title {} noenhanced", kPlotColors[curve % kPlotColors.size()],
                       curve % 2 == 0 ? "1" : "(8,4)", gnuplotText(label));
}

/// One panel: value(curve) is a gnuplot expression of the columns of energy.csv.
template <class Value>
std::string panel(const std::vector<EnergyCurve>& curves, const std::string& name, Value&& value)
{
    std::string text = fmt::format("set title {}\nplot", gnuplotText(name));
    for (std::size_t i = 0; i < curves.size(); ++i)
        text += fmt::format("{} {} skip 1 using 1:({}) {}", i == 0 ? "" : ", \\\n    ", gnuplotText(curves[i].csv.generic_string()), value(curves[i]),
                            look(i, curves[i].label));
    return text + "\n";
}

/// A panel of differences, with their numbers in the script itself; "" where there are none.
std::string differencePanel(const std::vector<EnergyCurve>& curves)
{
    std::string blocks, lines;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const EnergyDifference& difference = curves[i].difference;
        if (difference.times.empty()) continue;
        blocks += fmt::format("$difference_{} << END\n", i);
        for (std::size_t row = 0; row < difference.times.size(); ++row)
            blocks += fmt::format("{:.9g},{:.6g}\n", difference.times[row], difference.percent[row]);
        blocks += "END\n";
        lines += fmt::format("{} $difference_{} using 1:2 {}", lines.empty() ? "" : ", \\\n    ", i, look(i, curves[i].label));
    }
    if (lines.empty()) return "";
    return fmt::format("{}set title 'total, less that of the first method [% of the largest]'\nplot{}\n", blocks, lines);
}

/// What all panels have in common.
std::string head(int panels, const std::string& title, const std::string& unit, const std::string& picture)
{
    return fmt::format(
        "set terminal pngcairo size {},580 font 'DejaVu Sans,12' linewidth 1\n"
        "set output {}\n"
        "set datafile separator ','\n"
        "set multiplot layout 1,{} margins 0.085,0.975,0.24,0.86 spacing 0.065 title {} noenhanced font ',14'\n"
        "set border 3 lw 1\nset tics nomirror out scale 0.6\nset grid ytics lc rgb '#dddddd' lw 1\n"
        "set xlabel 'time [s]'\nset ylabel 'energy [{}]'\n"
        "set key at screen 0.5,0.045 center center vertical maxrows 2 samplen 2\n",
        550 * panels, gnuplotText(picture), panels, gnuplotText(title), unit);
}

/// "$13": a column of energy.csv by its name, as gnuplot counts them.
std::string columnOfEnergies(const std::string& name)
{
    const std::vector<std::string> columns = csvCells(std::string(kEnergyHeader));
    return fmt::format("${}", std::ranges::find(columns, name) - columns.begin() + 1);
}

/// Draw folder/name.png by script(curves, picture), whose curves are told relative to the folder.
template <class Script>
void draw(const std::vector<EnergyCurve>& curves, const std::filesystem::path& folder, const std::string& name, Script&& script)
{
    auto relative = curves;
    for (auto& curve : relative) curve.csv = std::filesystem::relative(curve.csv, folder);
    drawPlot(folder, name, [&](const std::string& picture) { return script(relative, picture); });
}

}  // namespace

void joinEnergies(const std::vector<EnergyCurve>& curves, const std::filesystem::path& target)
{
    std::string all;
    for (const auto& curve : curves) {
        std::istringstream in(readWhole(curve.csv));
        std::string line;
        std::getline(in, line);
        if (all.empty()) all = "variant," + line + '\n';
        while (std::getline(in, line)) all += curve.variant + ',' + line + '\n';
    }
    writeWhole(target, all);
}

std::string energyPlotScript(const std::vector<EnergyCurve>& curves, int scale, const std::string& title, const std::string& picture)
{
    const std::string unit = scale == 0 ? "erg" : fmt::format("10^{{{}}} erg", scale);
    const auto scaled = [&](const std::string& value) { return [=](const EnergyCurve&) { return fmt::format("({})*1e{}", value, -scale); }; };
    return head(3, title, unit, picture) + panel(curves, "kinetic", scaled("$2+$3")) + "unset key\nunset ylabel\n" +
           panel(curves, "potential", scaled("$4")) + panel(curves, "total", scaled("$5")) + "unset multiplot\n";
}

std::string perParticleScript(const std::vector<EnergyCurve>& curves, const std::string& title, const std::string& picture)
{
    const auto perParticle = [](const std::string& value) {
        return [=](const EnergyCurve& curve) { return fmt::format("{}/($6+{})", value, curve.vertices); };
    };
    const std::string difference = differencePanel(curves);
    return head(difference.empty() ? 2 : 3, title, "erg per particle", picture) +
           panel(curves, "kinetic + potential + elastic", perParticle(columnOfEnergies("total_erg"))) + "unset key\nunset ylabel\n" +
           panel(curves, "as published (no motion of the liquid)", perParticle(columnOfEnergies("published_erg"))) + difference + "unset multiplot\n";
}

void plotEnergies(const std::vector<EnergyCurve>& curves, const std::string& title, const std::filesystem::path& folder)
{
    const int scale = axisScale(curves);
    draw(curves, folder, "energy",
         [&](const auto& relative, const std::string& picture) { return energyPlotScript(relative, scale, title, picture); });
}

void plotPerParticle(const std::vector<EnergyCurve>& curves, const std::string& title, const std::filesystem::path& folder, const std::string& name)
{
    draw(curves, folder, name, [&](const auto& relative, const std::string& picture) { return perParticleScript(relative, title, picture); });
}

}  // namespace app
