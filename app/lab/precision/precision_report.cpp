#include "app/lab/precision/precision_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

namespace {

std::string nameOf(const PrecisionRow& row)
{
    std::string text = row.names.method;
    for (const std::string& name : {row.names.integrator, row.names.step, row.names.resolution})
        if (name != "-") text += ", " + name;
    return text;
}

std::string gainsTable(const PrecisionCase& of)
{
    const std::vector<Gain> gains = gainsOf(of);
    if (gains.empty()) return "";
    std::string text =
        "\n| published scheme | error | run time [s] | at equal error [s] | part of it | fastest run as near | error | "
        "run time [s] |\n"
        "|---|---:|---:|---:|---:|---|---:|---:|\n";
    for (const Gain& gain : gains)
        text += fmt::format("| {} | {:.3g} | {:.3g} | {:.3g} | 1/{:.1f} | {} | {:.3g} | {:.3g} |\n", nameOf(*gain.published), gain.published->error,
                            gain.published->wallSeconds, gain.seconds, gain.factor(), nameOf(*gain.ours), gain.ours->error, gain.ours->wallSeconds);
    return text;
}

/// Rows of methods, columns of steps: at the first resolution.
std::string viscosityTable(const PrecisionCase& of)
{
    const auto known = [](const PrecisionRow& row) { return std::isfinite(row.viscosity); };
    if (std::ranges::none_of(of.rows, known)) return "";
    std::string text = fmt::format("\nNumerical viscosity [cm²/s], {}:\n\n| |", of.precision.resolutions.front().name), line = "\n|---|";
    for (const PrecisionChoice& step : of.precision.steps) text += fmt::format(" {} |", step.name), line += "---:|";
    text += line + "\n";
    for (const PrecisionChoice& method : of.precision.methods)
        for (const PrecisionChoice& integrator : of.precision.integrators) {
            std::string values;
            for (const PrecisionChoice& step : of.precision.steps) {
                const PrecisionNames names{method.name, integrator.name, step.name, of.precision.resolutions.front().name};
                const auto row = std::ranges::find(of.rows, names, &PrecisionRow::names);
                values += row == of.rows.end() ? " - |" : fmt::format(" {:.2e} |", row->viscosity);
            }
            if (values.find_first_of("0123456789") != std::string::npos) text += fmt::format("| {}, {} |{}\n", method.name, integrator.name, values);
        }
    return text;
}

}  // namespace

std::string gainSentence(const PrecisionCase& of)
{
    const std::vector<Gain> gains = gainsOf(of);
    if (gains.empty()) return "";
    const Gain& gain = gains.front();
    return fmt::format("at equal error the best of ours needs 1/{:.1f} of the run time of the published scheme ({})", gain.factor(),
                       nameOf(*gain.published));
}

std::string precisionReport(const std::vector<PrecisionCase>& cases, const std::string& machine, bool withPlots)
{
    std::string text = fmt::format("# Error and run time\n\nOn {}. Run time is that of the steps alone.\n", machine);
    for (const PrecisionCase& of : cases) {
        text += fmt::format("\n## {}\n\n{}\n", of.title, of.precision.about);
        if (of.front().empty()) continue;
        const int repeats = std::ranges::max(of.rows, {}, &PrecisionRow::repeats).repeats;
        text += fmt::format("{} runs, threads: {}, times of the front and of the published scheme: median of {}.\n", of.rows.size(),
                            of.rows.front().threads, repeats);
        if (const std::string sentence = gainSentence(of); !sentence.empty()) text += fmt::format("\n**{}: {}.**\n", of.title, sentence);
        text += gainsTable(of) + viscosityTable(of);
        if (withPlots) text += fmt::format("\n![{}](work_precision_{}.png)\n", of.title, of.name);
    }
    return text;
}

}  // namespace app
