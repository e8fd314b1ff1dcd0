#include "app/lab/precision/precision_plot.h"

#include "app/system/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

/// A line of a plot: of one method and integrator.
struct Curve {
    std::string name;
    std::size_t method = 0, integrator = 0;
    std::vector<std::array<double, 2>> points;
};

std::string label(const std::string& method, const std::string& integrator) { return integrator == "-" ? method : method + ", " + integrator; }

/// Colours tell methods, dashes integrators.
std::string look(const Curve& curve)
{
    return fmt::format("lc rgb '{}' dt {}", kPlotColors[curve.method % kPlotColors.size()], curve.integrator == 0 ? "(9,5)" : "1");
}

/// The numbers within the script itself.
std::string block(const std::string& name, const std::vector<std::array<double, 2>>& points)
{
    std::string text = fmt::format("${} << EOD\n", name);
    for (const auto& [x, y] : points) text += fmt::format("{:.6g} {:.6g}\n", x, y);
    return text + "EOD\n";
}

std::vector<std::array<double, 2>> pointsOf(const std::vector<Cost>& costs)
{
    std::vector<std::array<double, 2>> points;
    for (const Cost& cost : costs)
        if (cost.seconds > 0.0 && cost.error > 0.0) points.push_back({cost.seconds, cost.error});
    return points;
}

/// curve(method, integrator) for all of a case.
template <class Points>
std::vector<Curve> curvesOf(const PrecisionCase& of, Points&& points)
{
    std::vector<Curve> curves;
    const auto& [methods, integrators] = std::tie(of.precision.methods, of.precision.integrators);
    for (std::size_t m = 0; m < methods.size(); ++m)
        for (std::size_t i = 0; i < integrators.size(); ++i) {
            Curve curve{label(methods[m].name, integrators[i].name), m, integrators.size() == 1 ? 1 : i,
                        points(methods[m].name, integrators[i].name)};
            if (!curve.points.empty()) curves.push_back(std::move(curve));
        }
    return curves;
}

std::string workPanel(const PrecisionCase& of, std::size_t number)
{
    const auto costs = curvesOf(of, [&](auto& method, auto& integrator) { return pointsOf(of.costsOf(method, integrator)); });
    const auto fronts = curvesOf(of, [&](auto& method, auto& integrator) { return pointsOf(paretoFront(of.costsOf(method, integrator))); });
    std::vector<Cost> published;
    for (const Gain& gain : gainsOf(of)) published.push_back({gain.published->wallSeconds, gain.published->error});
    const auto id = [&](const char* what, std::size_t i = 0) { return fmt::format("{}_{}_{}", what, number, i); };

    std::string text = block(id("front"), pointsOf(of.front())) + block(id("published"), pointsOf(published));
    for (std::size_t i = 0; i < costs.size(); ++i) text += block(id("all", i), costs[i].points);
    for (std::size_t i = 0; i < fronts.size(); ++i) text += block(id("best", i), fronts[i].points);
    text += fmt::format("set title {} noenhanced\nplot ${} with lines lw 9 lc rgb '#d0d0d0' title 'best of all'", gnuplotText(of.title), id("front"));
    for (std::size_t i = 0; i < costs.size(); ++i)
        text +=
            fmt::format(", \\\n  ${} with points pt 7 ps 0.5 lc rgb '{}' notitle", id("all", i), kPlotColors[costs[i].method % kPlotColors.size()]);
    for (std::size_t i = 0; i < fronts.size(); ++i)
        text += fmt::format(", \\\n  ${} with lines lw 1.6 {} title {} noenhanced", id("best", i), look(fronts[i]), gnuplotText(fronts[i].name));
    if (!published.empty())
        text += fmt::format(", \\\n  ${} with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'", id("published"));
    return text + "\n";
}

/// What stands before the panels: a picture whose key has room for all names below them.
std::string head(std::size_t panels, const std::vector<std::string>& names, const std::string& picture)
{
    constexpr std::size_t kPanelWidth = 640, kPerLetter = 7, kBesideName = 50, kPerRow = 14, kAboveKey = 490;  // pixels
    std::size_t longest = 0;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    const std::size_t columns = std::max<std::size_t>(1, kPanelWidth * panels / (kPerLetter * longest + kBesideName));
    const std::size_t rows = std::max<std::size_t>(5, (names.size() + columns - 1) / columns);
    return fmt::format(
        "set terminal pngcairo size {},{} font 'DejaVu Sans,11'\nset output {}\n"
        "set border 3 lw 1\nset tics nomirror out scale 0.6\nset grid lc rgb '#e4e4e4' lw 1\n"
        "set logscale xy\nset format '10^{{%T}}'\nset bmargin {}\nset key at screen 0.5,0.03 center bottom vertical "
        "maxrows {} samplen 2.5 font ',9'\n",
        kPanelWidth * panels, kAboveKey + kPerRow * rows, gnuplotText(picture), 4 + rows, rows);
}

/// Names in a picture's key: of all curves of a case, of the best of all, and of the published scheme.
std::vector<std::string> namesOf(const PrecisionCase& of)
{
    std::vector<std::string> names = {"best of all", "published scheme"};
    const auto curves = curvesOf(of, [&](auto& method, auto& integrator) { return pointsOf(of.costsOf(method, integrator)); });
    for (const Curve& curve : curves) names.push_back(curve.name);
    return names;
}

std::vector<std::array<double, 2>> viscositiesOf(const PrecisionCase& of, const std::string& method, const std::string& integrator)
{
    std::vector<std::array<double, 2>> points;
    for (const PrecisionRow& row : of.rows)
        if (row.names.method == method && row.names.integrator == integrator && row.names.resolution == of.precision.resolutions.front().name &&
            std::isfinite(row.viscosity) && row.viscosity != 0.0)
            points.push_back({row.dt, std::abs(row.viscosity)});
    std::ranges::sort(points);
    return points;
}

}  // namespace

std::string workPrecisionScript(const std::vector<const PrecisionCase*>& cases, const std::string& picture)
{
    std::vector<std::string> names;
    for (const PrecisionCase* of : cases)
        for (const std::string& name : namesOf(*of))
            if (!std::ranges::count(names, name)) names.push_back(name);
    std::string text = head(cases.size(), names, picture) + "set xlabel 'run time [s]'\nset ylabel 'relative error'\n";
    if (cases.size() > 1) text += fmt::format("set multiplot layout 1,{}\n", cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) text += workPanel(*cases[i], i);
    return cases.size() > 1 ? text + "unset multiplot\n" : text;
}

std::string viscosityScript(const PrecisionCase& of, const std::string& picture)
{
    const auto curves = curvesOf(of, [&](auto& method, auto& integrator) { return viscositiesOf(of, method, integrator); });
    std::string text = head(1, namesOf(of), picture) +
                       fmt::format("set xlabel 'time step [s]'\nset ylabel '|numerical viscosity| [cm^2/s]'\nset title {} noenhanced\n",
                                   gnuplotText(of.title + ", " + of.precision.resolutions.front().name));
    for (std::size_t i = 0; i < curves.size(); ++i) text += block(fmt::format("curve_{}", i), curves[i].points);
    for (std::size_t i = 0; i < curves.size(); ++i)
        text += fmt::format("{} $curve_{} with linespoints pt 7 ps 0.7 lw 1.6 {} title {} noenhanced", i == 0 ? "plot" : ", \\\n ", i,
                            look(curves[i]), gnuplotText(curves[i].name));
    return text + "\n";
}

void plotPrecision(const std::vector<PrecisionCase>& cases, const std::filesystem::path& folder)
{
    std::vector<const PrecisionCase*> drawn;
    for (const PrecisionCase& of : cases) {
        if (of.front().empty()) continue;
        if (of.precision.isHeadline) drawn.push_back(&of);
        drawPlot(folder, "work_precision_" + of.name, [&](const std::string& picture) { return workPrecisionScript({&of}, picture); });
        const auto hasViscosity = [](const PrecisionRow& row) { return std::isfinite(row.viscosity); };
        if (std::ranges::any_of(of.rows, hasViscosity))
            drawPlot(folder, "numerical_viscosity", [&](const std::string& picture) { return viscosityScript(of, picture); });
    }
    if (drawn.size() > 1) drawPlot(folder, "work_precision", [&](const std::string& picture) { return workPrecisionScript(drawn, picture); });
}

}  // namespace app
