#include "app/lab/validation/validation_report.h"

#include "app/lab/validation/validation_plot.h"
#include "app/system/atomic_files.h"
#include "app/system/gnuplot.h"
#include "app/system/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace app {

namespace {

std::string withUnit(double value, const std::string& unit)
{
    return std::isfinite(value) ? fmt::format("{:.5g}{}{}", value, unit.empty() ? "" : " ", unit) : "-";
}

std::string deviation(const Finding& finding)
{
    if (!std::isfinite(finding.expected) || !std::isfinite(finding.value)) return "-";
    const double error = finding.value - finding.expected;
    return finding.expected == 0.0 ? fmt::format("{:+.2g}", error) : fmt::format("{:+.2f} %", 100.0 * error / std::abs(finding.expected));
}

/// How a check came out: what was measured has a scatter, and models have limits.
std::string verdict(const CaseResult& result, std::size_t i)
{
    const bool passes = result.findings[i].passes, isMeasured = result.validation.kind == KnownFrom::Measured;
    if (!isMeasured) return passes ? "passes" : "**fails**";
    if (result.fails(i)) return "**outside**";
    if (result.validation.checks[i].outside.empty()) return "inside";
    return passes ? "inside, said to be outside" : "outside, as said below";
}

std::string rowOf(const CaseResult& result, std::size_t i)
{
    const Check& check = result.validation.checks[i];
    const Finding& finding = result.findings[i];
    const std::string unit =
        check.hasCurve() && check.statistic != Statistic::RmsDifference ? "" : check.unit;  // relative errors and shares have none
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", result.name, check.name, withUnit(finding.value, unit),
                       withUnit(finding.expected, unit), deviation(finding), bounds(check), verdict(result, i));
}

std::string rowsOf(const CaseResult& result)
{
    std::string rows;
    for (std::size_t i = 0; i < result.findings.size(); ++i) rows += rowOf(result, i);
    if (!result.failure.empty()) rows += fmt::format("| {} | {} | - | - | - | - | **fails** |\n", result.name, result.failure);
    return rows;
}

std::string paragraph(const CaseResult& result, bool withPlots)
{
    const Validation& validation = result.validation;
    const std::string& title = result.setup.scene.title;
    std::string text = fmt::format("\n### {}\n\n{}\n\n{} {}. {} steps, {}.\n", title, validation.about,
                                   validation.kind == KnownFrom::Measured ? "Measured by" : "Known from:", validation.source, result.steps,
                                   formatDuration(result.wallSeconds));
    for (const Check& check : validation.checks)
        if (!check.outside.empty()) text += fmt::format("\nOutside: {}. {}\n", check.name, check.outside);
    if (withPlots) text += fmt::format("\n![{}]({}.png)\n", title, result.name);
    return text;
}

}  // namespace

std::string findingsTable(const std::vector<CaseResult>& results)
{
    std::string text;
    for (const KnownFrom kind : {KnownFrom::Theory, KnownFrom::Measured}) {
        const auto isOfIt = [&](const CaseResult& result) { return result.validation.kind == kind; };
        if (std::ranges::none_of(results, isOfIt)) continue;
        text += fmt::format("{}## {}\n\n| case | check | found | {} | deviation | allowed | |\n|---|---|---:|---:|---:|---|---|\n",
                            text.empty() ? "" : "\n", kind == KnownFrom::Measured ? "Measured" : "Theory", knownAs(kind));
        for (const CaseResult& result : results)
            if (isOfIt(result)) text += rowsOf(result);
    }
    return text;
}

std::string validationReport(const std::vector<CaseResult>& results, bool isQuick, bool withPlots)
{
    const auto passed = std::ranges::count_if(results, &CaseResult::passes);
    double seconds = 0.0;
    for (const CaseResult& result : results) seconds += result.wallSeconds;
    std::string text = fmt::format("# Validation{}\n\n{} of {} cases pass, in {}.\n\n{}\n## Cases\n", isQuick ? " (quick)" : "", passed,
                                   results.size(), formatDuration(seconds), findingsTable(results));
    for (const CaseResult& result : results) text += paragraph(result, withPlots);
    return text;
}

void writeReadings(const CaseResult& result, const std::filesystem::path& folder)
{
    std::string csv = "check,at,found,known,lower,upper\n";
    for (std::size_t i = 0; i < result.readings.size(); ++i)
        for (const Sample& reading : result.readings[i])
            fmt::format_to(std::back_inserter(csv), "{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", i, reading.at, reading.value, reading.expected,
                           reading.lower, reading.upper);
    writeWhole(folder / (result.name + ".csv"), csv);
    const auto enough = [](const auto& readings) { return readings.size() > 1; };
    if (canPlot() && std::ranges::all_of(result.readings, enough))
        drawPlot(folder, result.name, [&](const std::string& picture) { return validationPlotScript(result, picture); });
}

}  // namespace app
