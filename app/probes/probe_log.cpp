#include "app/probes/probe_log.h"

#include "app/system/csv.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

namespace app {

namespace {

/// Tells for each column of a table whether any of its cells has a value.
std::vector<bool> columnsWithValues(const std::filesystem::path& file, std::size_t columns)
{
    std::vector<bool> has(columns, false);
    std::ifstream in(file);
    std::string line;
    for (std::getline(in, line); std::getline(in, line);) {
        const std::vector<std::string> cells = csvCells(line);
        for (std::size_t c = 0; c < std::min(columns, cells.size()); ++c)
            if (!cells[c].empty()) has[c] = true;
    }
    return has;
}

}  // namespace

ProbeLog::ProbeLog(const std::filesystem::path& file, const Probes& probes, double start) : file_(file), reader_(probes, start)
{
    file_.add(fmt::format("{}", fmt::join(probes.columns(), ",")));
}

ProbeLog::ProbeLog(const std::filesystem::path& file, const Probes& probes, double start, double time, std::uintmax_t bytes,
                   const IntervalTotals& sinceReading)
    : file_(file, bytes), reader_(probes, start, time, sinceReading)
{
}

void ProbeLog::initial(const SimulationHandle& simulation) { write(reader_.initial(simulation)); }

void ProbeLog::step(const SimulationHandle& simulation, bool isReflected)
{
    if (const auto reading = reader_.step(simulation, isReflected)) write(*reading);
}

void ProbeLog::write(const ProbeReading& reading)
{
    std::string row = fmt::format("{:.9g}", reading.time);
    for (const std::optional<double>& value : reading.values) row += value ? fmt::format(",{:.9g}", *value) : ",";
    file_.add(row);
}

void plotProbes(const Probes& probes, const std::string& title, const std::filesystem::path& folder)
{
    constexpr int kColumns = 2, kWidth = 560, kHeight = 320;
    const int count = static_cast<int>(probes.all.size()), columns = std::min(count, kColumns), rows = (count + columns - 1) / columns;
    const std::vector<bool> has = columnsWithValues(folder / kProbesFile, probes.columns().size());
    // of columns as gnuplot counts them, from 1
    const auto hasNone = [&](std::size_t first, std::size_t last) {
        return std::none_of(has.begin() + static_cast<std::ptrdiff_t>(first) - 1, has.begin() + static_cast<std::ptrdiff_t>(last),
                            [](bool one) { return one; });
    };
    drawPlot(folder, "probes", [&](const std::string& picture) {
        std::string text = fmt::format(
            "set terminal pngcairo size {},{} font 'DejaVu Sans,11' linewidth 1\nset output {}\nset datafile separator ','\n"
            "set multiplot layout {},{} title {} noenhanced\nset border 3 lw 1\nset tics nomirror out scale 0.6\n"
            "set grid ytics lc rgb '#dddddd' lw 1\nset xlabel 'time [s]'\n",
            kWidth * columns, kHeight * rows + 40, gnuplotText(picture), rows, columns, gnuplotText(title));
        std::size_t column = 2;
        for (const Probe& probe : probes.all) {
            const std::size_t lines = std::max<std::size_t>(1, probe.points.size()), last = column + lines - 1;
            text += fmt::format("set title {} noenhanced\nset ylabel {}\n", gnuplotText(probe.name), gnuplotUnit(probe.unit));
            if (hasNone(column, last)) text += "set key center\nplot [0:1] [0:1] -1 title 'no value'\n";  // gnuplot refuses lines without a point
            else if (lines == 1)
                text += fmt::format("unset key\nplot 'probes.csv' skip 1 using 1:(valid({0}) ? column({0}) : NaN) with lines lw 2 lc rgb '{1}'\n",
                                    column, kPlotColors[2]);
            else  // along a line from dark to light, with the ends named; where cells are empty lines break off
                text += fmt::format(
                    "set key outside right center\nset palette defined (0 '#440154', 0.5 '#21918c', 1 '#fde725')\nunset colorbox\nset cbrange "
                    "[{0}:{1}]\nplot for [c={0}:{1}] 'probes.csv' skip 1 using 1:(valid(c) ? column(c) : NaN) with lines "
                    "lw 2 lc palette cb c title (c == {0} ? 'at 0 cm' : c == {1} ? 'at {2:.4g} cm' : '')\n",
                    column, last, (probe.points.back() - probe.points.front()).norm());
            column += lines;
        }
        return text + "unset multiplot\n";
    });
}

}  // namespace app
