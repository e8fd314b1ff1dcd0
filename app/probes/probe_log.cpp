#include "app/probes/probe_log.h"

#include "app/parts.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <cmath>

namespace app {

namespace {

/// A time that is a whole number of intervals but for rounding is the last of them.
std::int64_t readingsUpTo(double time, double every) { return std::llround(std::floor(time / every + 1.0e-9)); }

}  // namespace

ProbeLog::ProbeLog(const std::filesystem::path& file, const Probes& probes, double start) : file_(file), probes_(probes), start_(start)
{
    file_.add(fmt::format("{}", fmt::join(probes_.columns(), ",")));
}

ProbeLog::ProbeLog(const std::filesystem::path& file, const Probes& probes, double start, double time, std::uintmax_t bytes,
                   const ForceTotals& sinceReading)
    : file_(file, bytes), probes_(probes), start_(start), next_(readingsUpTo(time - start, probes.every) + 1)
{
    probes_.measures->goOnWith(sinceReading);
}

void ProbeLog::initial(const Steppable& simulation)
{
    probes_.measures->look(simulation);
    read(simulation);
}

void ProbeLog::step(const Steppable& simulation, bool isReflected)
{
    probes_.measures->goOnLooking(simulation);
    probes_.measures->tookStep();
    if (!isReflected && readingsUpTo(simulation.state().time - start_, probes_.every) >= next_) read(simulation);
}

std::string ProbeLog::valueOf(const Probe& probe, std::span<const double> at)
try {
    return fmt::format(",{:.9g}", probe.read(at));
} catch (const sim::FormulaError& error) {
    if (valueless_.insert(probe.name).second)
        spdlog::warn("output.probes: {} has no value at {:.6g} s, its cell stays empty: {}", probe.name, at[0], error.what());
    return ",";
}

void ProbeLog::read(const Steppable& simulation)
{
    const double time = simulation.state().time;
    std::string row = fmt::format("{:.9g}", time);
    for (const Probe& probe : probes_.all) {
        if (probe.points.empty()) row += valueOf(probe, std::array{time});
        for (const sim::Vec3& x : probe.points) row += valueOf(probe, std::array{time, x[0], x[1], x[2]});
    }
    file_.add(row);
    probes_.measures->startInterval();
    next_ = readingsUpTo(time - start_, probes_.every) + 1;
}

void plotProbes(const Probes& probes, const std::string& title, const std::filesystem::path& folder)
{
    constexpr int kColumns = 2, kWidth = 560, kHeight = 320;
    const int count = static_cast<int>(probes.all.size()), columns = std::min(count, kColumns), rows = (count + columns - 1) / columns;
    drawPlot(folder, "probes", [&](const std::string& picture) {
        std::string text = fmt::format(
            "set terminal pngcairo size {},{} font 'DejaVu Sans,11' linewidth 1\nset output {}\nset datafile separator ','\n"
            "set multiplot layout {},{} title {} noenhanced\nset border 3 lw 1\nset tics nomirror out scale 0.6\n"
            "set grid ytics lc rgb '#dddddd' lw 1\nset xlabel 'time [s]'\n",
            kWidth * columns, kHeight * rows + 40, gnuplotText(picture), rows, columns, gnuplotText(title));
        std::size_t column = 2;
        for (const Probe& probe : probes.all) {
            const std::size_t lines = std::max<std::size_t>(1, probe.points.size()), last = column + lines - 1;
            text += fmt::format("set title {} noenhanced\nset ylabel {} noenhanced\n", gnuplotText(probe.name),
                                gnuplotText(fmt::format("[{}]", probe.unit)));
            if (lines == 1)
                text += fmt::format("unset key\nplot 'probes.csv' skip 1 using 1:(valid({0}) ? column({0}) : NaN) with lines lw 2 lc rgb '{1}'\n",
                                    column, kPlotColors[2]);
            else  // along a line from dark to light, with the ends named; where cells are empty lines break off
                text += fmt::format(
                    "set key outside right center\nset palette defined (0 '#440154', 0.5 '#21918c', 1 '#fde725')\nunset colorbox\nset cbrange "
                    "[{0}:{1}]\nplot for [c={0}:{1}] 'probes.csv' skip 1 using 1:(valid(c) ? column(c) : NaN) with lines "
                    "lw 2 lc palette cb c title (c == {0} || c == {1} ? sprintf('point %d', c - {0} + 1) : '')\n",
                    column, last);
            column += lines;
        }
        return text + "unset multiplot\n";
    });
}

}  // namespace app
