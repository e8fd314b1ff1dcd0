#include "app/lab/stability/stability_report.h"

#include "app/lab/endings/run_course.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace app {

namespace {

std::string milliseconds(double seconds) { return fmt::format("{:g}", 1000.0 * seconds); }

const StabilityRow* rowOf(const StabilityResult& result, const StabilityMethod& method, double dt)
{
    const auto found = std::ranges::find_if(result.rows, [&](const StabilityRow& row) {
        return row.method == method.name && std::abs(row.dt - dt) < 1.0e-6 * dt &&
               std::abs(row.duration - result.map.duration) < 1.0e-6 * row.duration;
    });
    return found == result.rows.end() ? nullptr : &*found;
}

/// One word for a cell of the map: "cut", "energy", "speed", "stopped", …
std::string reasonWord(const StabilityRow& row) { return row.isStable ? "" : row.why.substr(0, row.why.find_first_of(" :")); }

std::string plotScript(const StabilityResult& result, const std::string& picture)
{
    const auto& [scene, sets, methods, steps, duration, folder, largestOnly, width, limit, stop] = result.map;
    std::string cells, words, methodNames, stepNames;
    for (std::size_t m = 0; m < methods.size(); ++m) {
        methodNames += fmt::format("{}{} {}", m > 0 ? ", " : "", gnuplotText(methods[m].name), m);
        for (std::size_t s = 0; s < steps.size(); ++s) {
            const StabilityRow* row = rowOf(result, methods[m], steps[s]);
            fmt::format_to(std::back_inserter(cells), "{} {} {}\n", s, m, !row ? "0.5" : row->isStable ? "1" : "0");
            fmt::format_to(std::back_inserter(words), "{} {} \"{}\"\n", s, m, row ? reasonWord(*row) : "");
        }
    }
    for (std::size_t s = 0; s < steps.size(); ++s) stepNames += fmt::format("{}{} {}", s > 0 ? ", " : "", gnuplotText(milliseconds(steps[s])), s);
    return fmt::format(
        "set terminal pngcairo size {},{} font 'DejaVu Sans,11'\nset output {}\n$cells << END\n{}END\n$words << END\n{}END\n"
        "set label 1 {} at screen 0.5, screen 1 center offset 0,-1 noenhanced\nset tmargin 3\nset xlabel 'time step [ms]'\nset xtics ({}) "
        "scale 0\nset ytics ({}) scale 0 noenhanced\n"
        "set xrange [-0.5:{}]\nset yrange [{}:-0.5]\nset palette defined (0 '{}', 0.5 '#dddddd', 1 '{}')\nset cbrange [0:1]\n"
        "unset colorbox\nunset key\nplot $cells using 1:2:(0.48):(0.48):3 with boxxyerror fillstyle solid noborder linecolor palette, "
        "$words using 1:2:3 with labels tc rgb 'white' font ',9'\n",
        std::max<std::size_t>(600, 320 + 80 * steps.size()), 140 + 30 * methods.size(), gnuplotText(picture), cells, words,
        gnuplotText(fmt::format("{}: stable where blue", result.title)), stepNames, methodNames, static_cast<double>(steps.size()) - 0.5,
        static_cast<double>(methods.size()) - 0.5, kPlotColors[1], kPlotColors[2]);
}

std::string tableOf(const StabilityResult& result)
{
    std::string text = "| method | largest stable step [ms] |";
    std::string line = "\n|---|---:|";
    for (const double dt : result.map.steps) {
        text += fmt::format(" {} |", milliseconds(dt));
        line += "---|";
    }
    text += line + '\n';
    for (const StabilityMethod& method : result.map.methods) {
        const double largest = largestStableStep(result.rows, method.name, result.map.duration);
        text += fmt::format("| {} | {} |", method.name, largest > 0.0 ? milliseconds(largest) : "none");
        for (const double dt : result.map.steps) {
            const StabilityRow* row = rowOf(result, method, dt);
            text += fmt::format(" {} |", !row ? "?" : row->isStable ? "stable" : "**" + reasonWord(*row) + "**");
        }
        text += '\n';
    }
    return text;
}

}  // namespace

void plotStabilityMap(const StabilityResult& result)
{
    drawPlot(result.map.folder, "map", [&](const std::string& picture) { return plotScript(result, picture); });
}

std::string stabilityReport(const std::vector<StabilityResult>& results, bool withPlots)
{
    std::string text = fmt::format(
        "# Stable time steps\n\nEach run goes on at its time step, with the bounds on cells crossed per step lifted. It is stable if "
        "it comes to its end, all its numbers are finite, its energy never rises above that of the start (and the work of sources, "
        "suction, surface tension, obstacles, moving solids and pins) by more than {:g} of its largest kinetic energy, and no particle is "
        "faster than "
        "{:g} times the speed of all liquid, had it all that kinetic energy, or than the fastest solid. The largest stable step is one at which all "
        "shorter ones "
        "tried are stable too.\n",
        kAllowedGain, kAllowedSpeed);
    for (const StabilityResult& result : results) {
        text += fmt::format("\n## {}\n\n{} s each.\n\n{}", result.title, result.map.duration, tableOf(result));
        if (withPlots) text += fmt::format("\n![{}]({}/map.png)\n", result.title, result.name);
        std::string reasons;
        for (const StabilityRow& row : result.rows)
            if (!row.isStable) reasons += fmt::format("* {}, {} ms: {}\n", row.method, milliseconds(row.dt), row.why);
        if (!reasons.empty()) text += "\n" + reasons;
    }
    return text;
}

}  // namespace app
