#include "app/lab/checks/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

double between(double a, double b, double share) { return a + (b - a) * share; }

double valueOf(const Check& check, std::span<const double> now)
try {
    return check.read(now);
} catch (const sim::FormulaError&) {
    if (check.otherwise) return *check.otherwise;
    throw;
}

void readProfile(const Check& check, double time, std::vector<Sample>& readings)
{
    for (const Known& known : check.table)
        readings.push_back({known.at, valueOf(check, std::array{time, known.at}), known.value, known.lower, known.upper});
}

}  // namespace

bool Check::isProfileTime(double time) const
{
    constexpr double kRounding = 1.0e-6;  // of a time that is a sum of steps, relative to it
    return std::abs(time - *profileAt) <= kRounding * std::abs(*profileAt);
}

Known Check::knownAt(double time, double at) const
{
    Known known{.at = at, .value = std::numeric_limits<double>::quiet_NaN()};
    if (expect) known.value = (*expect)(std::array{time});
    if (expect || table.empty() || at < table.front().at || at > table.back().at) return known;
    const auto after = std::ranges::lower_bound(table, at, {}, &Known::at);
    if (after == table.begin()) return *after;
    const Known &above = *after, &below = *std::prev(after);
    const double share = (at - below.at) / (above.at - below.at);
    return {at, between(below.value, above.value, share), between(below.lower, above.lower, share), between(below.upper, above.upper, share)};
}

void readNow(const Check& check, double time, std::vector<Sample>& readings)
{
    if (check.profileAt) {
        if (check.isProfileTime(time)) readProfile(check, time, readings);
        return;
    }
    const std::array now = {time};
    const double at = check.against(now);
    if (at < check.from || at > check.to) return;
    const Known known = check.knownAt(time, at);
    const Sample reading{at, valueOf(check, now), known.value, known.lower, known.upper};
    if (!check.hasCurve() || std::isfinite(reading.expected)) readings.push_back(reading);
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
