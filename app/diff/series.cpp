#include "app/diff/series.h"

#include "sim/renamed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace app {

namespace {

/// Rows of A and B that belong together.
struct RowPairs {
    std::vector<std::pair<std::size_t, std::size_t>> both;
    std::vector<std::size_t> onlyA, onlyB;
};

/// Times as they are printed with nine digits.
bool isSameTime(double s, double t) { return std::abs(s - t) <= 2e-9 * std::max(std::abs(s), std::abs(t)); }

RowPairs pairRows(const Series& a, const Series& b)
{
    RowPairs pairs;
    const bool byTime = !a.times.empty() && !b.times.empty();
    std::size_t i = 0, j = 0;
    while (i < a.rows && j < b.rows) {
        if (!byTime || isSameTime(a.times[i], b.times[j])) pairs.both.emplace_back(i++, j++);
        else if (a.times[i] < b.times[j]) pairs.onlyA.push_back(i++);
        else pairs.onlyB.push_back(j++);
    }
    while (i < a.rows) pairs.onlyA.push_back(i++);
    while (j < b.rows) pairs.onlyB.push_back(j++);
    return pairs;
}

std::string placeOf(const Series& series, std::size_t row)
{
    if (!series.times.empty()) return fmt::format(" at {:.6g} s", series.times[row]);
    return series.rows > 1 ? fmt::format(" in row {}", row + 1) : "";
}

/// The vector of which a column is a component: "force" of "force[1]"; else the column itself.
std::string vectorOf(const std::string& column) { return column.ends_with(']') ? column.substr(0, column.rfind('[')) : column; }

/// Largest number of each vector.
std::map<std::string, double> scalesOf(const Series& series)
{
    std::map<std::string, double> scales;
    for (const auto& [column, values] : series.values) {
        double& scale = scales[vectorOf(column)];
        for (const double x : values) scale = std::fmax(scale, std::abs(x));
    }
    return scales;
}

/// NaN stands for a number that is not there: like another that is not there, unlike any other.
double distance(double x, double y)
{
    if (x == y || (std::isnan(x) && std::isnan(y))) return 0.0;
    return std::isnan(x) || std::isnan(y) ? std::numeric_limits<double>::infinity() : std::abs(x - y);
}

bool isIgnored(const std::string& column, const Tolerance& tolerance)
{
    return std::ranges::any_of(tolerance.ignore, [&](const std::string& ignored) {
        const std::string name = sim::currentName(ignored);
        return column == name || column.starts_with(name + '/') || column.starts_with(name + '[');
    });
}

DiffFinding diffColumn(const Series& a, const Series& b, const std::string& column, const RowPairs& rows, double scale, double tolerance)
{
    DiffFinding finding = {fmt::format("{}: {}", a.name, column), {}, false};
    const auto inA = a.values.find(column), inB = b.values.find(column);
    if (inA == a.values.end() || inB == b.values.end()) {
        finding.words = inA == a.values.end() ? "only B has it" : "only A has it";
        finding.differs = true;
        return finding;
    }
    double largest = 0.0;
    std::pair<std::size_t, std::size_t> worst;
    for (const auto& [i, j] : rows.both)
        if (const double d = distance(inA->second[i], inB->second[j]); d > largest) largest = d, worst = {i, j};
    if (largest == 0.0) return finding;
    const double x = inA->second[worst.first], y = inB->second[worst.second], relative = largest / scale;
    const auto told = [](double number) { return std::isnan(number) ? std::string("nothing") : fmt::format("{:.9g}", number); };
    finding.words = fmt::format("{} against {}", told(x), told(y));
    if (std::isfinite(relative)) finding.words += fmt::format(", {:.3g} of the largest", relative);
    finding.words += placeOf(a, worst.first);
    finding.differs = !(relative <= tolerance);
    return finding;
}

/// Rows that have no like in the other.
DiffFinding diffRows(const Series& a, const Series& b, const RowPairs& rows)
{
    DiffFinding finding = {fmt::format("{}: rows", a.name), {}, !rows.onlyA.empty() || !rows.onlyB.empty()};
    if (!finding.differs) return finding;
    finding.words = fmt::format("{} in both", rows.both.size());
    if (!rows.onlyA.empty()) finding.words += fmt::format(", {} only in A, the first{}", rows.onlyA.size(), placeOf(a, rows.onlyA.front()));
    if (!rows.onlyB.empty()) finding.words += fmt::format(", {} only in B, the first{}", rows.onlyB.size(), placeOf(b, rows.onlyB.front()));
    return finding;
}

}  // namespace

double valueAt(const Series& series, const std::vector<double>& values, double time)
{
    const auto above = std::ranges::lower_bound(series.times, time);
    if (above == series.times.end()) return values.empty() ? kNothing : values.back();
    const auto row = static_cast<std::size_t>(above - series.times.begin());
    if (row == 0 || *above == time) return values[row];
    const double before = series.times[row - 1];
    return std::lerp(values[row - 1], values[row], (time - before) / (*above - before));
}

std::vector<double> percentOfDifference(const Series& ours, const Series& theirs, const std::string& column)
{
    std::vector<double> percent(ours.rows, kNothing);
    const auto our = ours.values.find(column), their = theirs.values.find(column);
    if (our == ours.values.end() || their == theirs.values.end() || ours.times.empty() || theirs.times.empty()) return percent;
    double largest = 0.0;
    for (const double x : their->second) largest = std::fmax(largest, std::abs(x));
    for (std::size_t row = 0; row < ours.rows && largest > 0.0; ++row) {
        const double time = ours.times[row];
        if (time > theirs.times.back() && !isSameTime(time, theirs.times.back())) break;
        percent[row] = 100.0 * (our->second[row] - valueAt(theirs, their->second, time)) / largest;
    }
    return percent;
}

std::vector<DiffFinding> diffSeries(const Series& a, const Series& b, const Tolerance& tolerance)
{
    const RowPairs rows = pairRows(a, b);
    std::map<std::string, double> scales = scalesOf(a);
    std::vector<DiffFinding> findings = {diffRows(a, b, rows)};
    std::vector<std::string> columns = a.columns;
    for (const std::string& column : b.columns)
        if (!a.values.contains(column)) columns.push_back(column);
    for (const std::string& column : columns)
        if (!isIgnored(column, tolerance)) findings.push_back(diffColumn(a, b, column, rows, scales[vectorOf(column)], tolerance.series));
    return findings;
}

}  // namespace app
