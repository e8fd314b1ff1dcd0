#include "app/lab/checks/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace app {

double Check::expectedAt(double time, double at) const
{
    if (expect) return (*expect)(std::array{time});
    const auto after = std::ranges::lower_bound(table, at, {}, [](const auto& row) { return row[0]; });
    if (after == table.end() || (after == table.begin() && at < table.front()[0])) return std::numeric_limits<double>::quiet_NaN();
    if (after == table.begin()) return table.front()[1];
    const auto before = std::prev(after);
    return (*before)[1] + ((*after)[1] - (*before)[1]) * (at - (*before)[0]) / ((*after)[0] - (*before)[0]);
}

std::optional<Sample> readOnce(const Check& check, double time)
{
    const std::array now = {time};
    const double at = check.against(now);
    if (at < check.from || at > check.to) return std::nullopt;
    Sample reading{at, check.read(now), check.expectedAt(time, at)};
    if (check.hasCurve() && !std::isfinite(reading.expected)) return std::nullopt;
    return reading;
}

Finding judge(const Check& check, std::span<const Sample> readings)
{
    Finding finding;
    finding.value = statisticOf(check.statistic, readings, check.level);
    if (check.expect && !check.hasCurve() && !readings.empty()) finding.expected = readings.back().expected;
    const double error = std::abs(finding.value - finding.expected);
    finding.passes = std::isfinite(finding.value);
    if (check.tolerance) finding.passes = finding.passes && error <= *check.tolerance * std::abs(finding.expected);
    if (check.within) finding.passes = finding.passes && error <= *check.within;
    if (check.atMost) finding.passes = finding.passes && finding.value <= *check.atMost;
    if (check.atLeast) finding.passes = finding.passes && finding.value >= *check.atLeast;
    return finding;
}

std::string bounds(const Check& check)
{
    std::string text;
    const auto add = [&](const std::string& bound) { text += (text.empty() ? "" : ", ") + bound; };
    if (check.tolerance) add(fmt::format("within {:g} %", 100.0 * *check.tolerance));
    if (check.within) add(fmt::format("within {:g}", *check.within));
    if (check.atLeast) add(fmt::format("at least {:g}", *check.atLeast));
    if (check.atMost) add(fmt::format("at most {:g}", *check.atMost));
    return text;
}

}  // namespace app
