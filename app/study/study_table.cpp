#include "app/study/study_table.h"

#include "app/reports/run_report.h"
#include "app/system/atomic_files.h"
#include "app/system/csv.h"
#include "app/system/gnuplot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>

namespace app {

namespace {

struct Row {
    const StudyRun* run;
    StudyOutcome outcome;
    std::optional<RunResult> result;
    std::optional<double> energy;  ///< energy at the end [erg]
};

/// What came out of a run, as the columns name it.
struct Figure {
    const char* name;
    const char* title;  ///< title on the axis of a plot; null: no plot of it
    std::optional<double> (*of)(const Row&);
};
constexpr Figure kFigures[] = {
    {"steps", nullptr, [](const Row& r) { return std::optional(static_cast<double>(r.result->steps)); }},
    {"simulated_s", nullptr, [](const Row& r) { return std::optional(r.result->simulatedTime); }},
    {"wall_s", "wall time [s]", [](const Row& r) { return std::optional(r.result->wallSeconds); }},
    {"s_per_step", "seconds per step", [](const Row& r) { return std::optional(r.result->secondsPerStep); }},
    {"peak_memory_mb", nullptr, [](const Row& r) { return std::optional(r.result->peakMemoryMegabytes); }},
    {"particles", nullptr, [](const Row& r) { return std::optional(static_cast<double>(r.result->particles)); }},
    {"fabric_vertices", nullptr, [](const Row& r) { return std::optional(static_cast<double>(r.result->fabricVertices)); }},
    {"iterations_per_step", nullptr, [](const Row& r) { return std::optional(r.result->meanIterations); }},
    {"largest_cfl", nullptr, [](const Row& r) { return std::optional(r.result->largestCfl); }},
    {"mass_error", nullptr, [](const Row& r) { return std::optional(r.result->massError); }},
    {"energy_end_erg", "energy at the end [erg]", [](const Row& r) { return r.energy; }},
};

/// The total in the last row of energy.csv [erg].
std::optional<double> energyAtEnd(const std::filesystem::path& folder)
try {
    std::istringstream file(readWhole(folder / "energy.csv"));
    std::string line, last;
    while (std::getline(file, line)) last = line;
    return std::stod(csvCells(last).at(4));
} catch (const std::exception&) {
    return std::nullopt;  // not asked for, or nothing in it yet
}

constexpr std::string_view kStatusNames[] = {"waiting", "done", "failed", "interrupted"};

std::string valueOf(const StudyRun& run, const std::string& key)
{
    const auto found = std::ranges::find(run.values, key, &std::pair<std::string, std::string>::first);
    return found == run.values.end() ? "" : found->second;
}

std::string number(const std::optional<double>& x) { return x ? fmt::format("{:.6g}", *x) : ""; }

std::vector<std::string> header(const std::vector<std::string>& parameters)
{
    std::vector<std::string> cells = {"run"};
    cells.insert(cells.end(), parameters.begin(), parameters.end());
    cells.push_back("status");
    for (const Figure& figure : kFigures) cells.emplace_back(figure.name);
    cells.insert(cells.end(), {"state_hash", "reason"});
    return cells;
}

std::vector<std::string> cellsOf(const Row& row, const std::vector<std::string>& parameters)
{
    std::vector<std::string> cells = {row.run->name};
    for (const std::string& key : parameters) cells.push_back(valueOf(*row.run, key));
    cells.emplace_back(kStatusNames[static_cast<int>(row.outcome.status)]);
    for (const Figure& figure : kFigures) cells.push_back(row.result ? number(figure.of(row)) : "");
    cells.push_back(row.result ? row.result->stateHash : "");
    cells.push_back(row.outcome.reason);
    for (std::string& cell : cells) std::ranges::replace(cell, ',', ';');
    return cells;
}

std::string markdownRow(std::vector<std::string> cells)
{
    for (std::string& cell : cells) std::ranges::replace(cell, '|', '/');
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::optional<double> asNumber(const std::string& text)
{
    double x = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    return error == std::errc() && end == text.data() + text.size() && !text.empty() ? std::optional(x) : std::nullopt;
}

/// Seeds have no order that a plot could show.
bool isSeed(const std::string& key) { return key.ends_with(".seed"); }

using Points = std::vector<std::pair<double, double>>;

/// One line for each combination of the other parameters; empty unless the parameter has two numbers at least.
std::map<std::string, Points> curvesOver(const std::string& key, const std::vector<Row>& rows, const std::vector<std::string>& parameters,
                                         const Figure& figure)
{
    std::map<std::string, Points> curves;
    std::vector<double> values;
    for (const Row& row : rows) {
        const auto x = asNumber(valueOf(*row.run, key));
        const auto y = row.outcome.status == StudyStatus::Done ? figure.of(row) : std::nullopt;
        if (!x || !y) continue;
        std::vector<std::string> others;
        for (const std::string& other : parameters)
            if (other != key && !isSeed(other)) others.push_back(valueOf(*row.run, other));
        curves[fmt::format("{}", fmt::join(others, " "))].emplace_back(*x, *y);
        if (std::ranges::find(values, *x) == values.end()) values.push_back(*x);
    }
    if (values.size() < 2) curves.clear();
    for (auto& [name, points] : curves) std::ranges::sort(points);
    return curves;
}

std::string plotScript(const std::string& picture, const std::string& key, const std::map<std::string, Points>& curves, const Figure& figure)
{
    std::string blocks, lines;
    std::size_t n = 0;
    for (const auto& [name, points] : curves) {
        blocks += fmt::format("$curve{} << END\n", n);
        for (const auto& [x, y] : points) blocks += fmt::format("{:.9g} {:.9g}\n", x, y);
        blocks += "END\n";
        lines += fmt::format("{}$curve{} with linespoints pt 7 lw 2 lc rgb '{}' title {} noenhanced", n > 0 ? ", " : "", n,
                             kPlotColors[n % kPlotColors.size()], gnuplotText(name));
        ++n;
    }
    return fmt::format(
        "set terminal pngcairo size 720,480 font 'DejaVu Sans,11'\nset output {}\n{}set xlabel {} noenhanced\nset ylabel {}\nset grid lc "
        "rgb '#dddddd'\n"
        "set key {}\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\nplot {}\n",
        gnuplotText(picture), blocks, gnuplotText(key), gnuplotText(figure.title), curves.size() > 1 ? "outside right top" : "off", lines);
}

/// Names of the pictures that were made.
std::vector<std::string> drawPlots(const std::vector<Row>& rows, const std::vector<std::string>& parameters, const std::filesystem::path& folder)
{
    std::vector<std::string> made;
    if (!canPlot()) return made;
    for (const std::string& key : parameters)
        for (const Figure& figure : kFigures) {
            if (!figure.title || isSeed(key)) continue;
            const auto curves = curvesOver(key, rows, parameters, figure);
            if (curves.empty()) continue;
            made.push_back(fmt::format("{}_over_{}", figure.name, key));
            drawPlot(folder, made.back(), [&](const std::string& picture) { return plotScript(picture, key, curves, figure); });
        }
    return made;
}

}  // namespace

std::string gatherStudy(const Study& study, const StudyPlaces& places)
{
    const std::vector<std::string> parameters = study.parameters();
    std::vector<Row> rows;
    for (const StudyRun& run : study.runs) {
        Row row = {&run, outcomeOf(run, places), std::nullopt, std::nullopt};
        if (row.outcome.status != StudyStatus::Waiting) {
            row.result = readReport(places.of(run));
            row.energy = energyAtEnd(places.of(run));
        }
        rows.push_back(std::move(row));
    }
    const std::vector<std::string> head = header(parameters);
    std::string csv = fmt::format("{}\n", fmt::join(head, ","));
    std::string markdown = fmt::format("# {}\n\n", study.name) + markdownRow(head) + markdownRow(std::vector<std::string>(head.size(), "---"));
    for (const Row& row : rows) {
        const std::vector<std::string> cells = cellsOf(row, parameters);
        csv += fmt::format("{}\n", fmt::join(cells, ","));
        markdown += markdownRow(cells);
    }
    for (const std::string& plot : drawPlots(rows, parameters, places.folder)) markdown += fmt::format("\n![{0}]({0}.png)\n", plot);
    writeWhole(places.folder / "study.csv", csv);
    writeWhole(places.folder / "study.md", markdown);
    return markdown;
}

}  // namespace app
