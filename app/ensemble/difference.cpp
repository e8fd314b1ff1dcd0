#include "app/ensemble/difference.h"

#include "app/system/markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

namespace {

/// Numbers that differ by less are the same: logs have twelve digits.
constexpr double kSameWithin = 1.0e-11;

bool isConstant(const Spread& a, const Spread& b)
{
    const double low = std::min(a.lowest, b.lowest), high = std::max(a.highest, b.highest);
    return high - low <= kSameWithin * std::max(std::abs(low), std::abs(high));
}

/// By its name in the log, once; what is 0 everywhere is not worth a word.
void addConstant(const EnsembleColumn& column, std::vector<std::string>& constant)
{
    const std::string name = column.name.substr(0, column.name.rfind(", "));
    if (column.spread().mean != 0.0 && std::ranges::find(constant, name) == constant.end()) constant.push_back(name);
}

std::string inPercent(double part, double whole) { return whole != 0.0 ? fmt::format("{:+.3g} %", 100.0 * part / std::abs(whole)) : ""; }

/// "1.2 to 3.4", or nothing where there are too few runs.
std::string intervalOf(const MeanDifference& found)
{
    if (!std::isfinite(found.margin)) return "too few runs";
    return fmt::format("{:.4g} to {:.4g}", found.difference - found.margin, found.difference + found.margin);
}

std::string differenceRow(const ColumnDifference& column, const std::string& verdict)
{
    return fmt::format("| {} | {:.5g} ± {:.2g} | {:.5g} ± {:.2g} | {:.4g} | {} | {} | {} |\n", markdownCell(column.name), column.a.mean,
                       column.a.deviation, column.b.mean, column.b.deviation, column.found.difference, intervalOf(column.found),
                       inPercent(column.found.difference, column.a.mean), verdict);
}

}  // namespace

double ColumnDifference::clearness() const
{
    if (found.margin == 0.0) return found.difference == 0.0 ? 0.0 : std::numeric_limits<double>::infinity();
    return std::abs(found.difference) / found.margin;
}

std::size_t EnsembleDifference::seen() const
{
    return static_cast<std::size_t>(std::ranges::count_if(judged, [](const ColumnDifference& column) { return column.found.isSeen(); }));
}

EnsembleDifference differenceOf(const std::vector<EnsembleColumn>& a, const std::vector<EnsembleColumn>& b, double confidence)
{
    EnsembleDifference difference;
    difference.confidence = confidence;
    for (const EnsembleColumn& inA : a) {
        const auto inB = std::ranges::find(b, inA.name, &EnsembleColumn::name);
        if (inB == b.end()) continue;
        const ColumnDifference column = {.name = inA.name, .a = inA.spread(), .b = inB->spread(), .found = {}};
        if (column.a.count == 0 || column.b.count == 0) continue;
        if (inA.isOfMachine) difference.ofMachine.push_back(column);
        else if (isConstant(column.a, column.b)) addConstant(inA, difference.constant);
        else difference.judged.push_back(column);
    }
    const double each = 1.0 - (1.0 - confidence) / static_cast<double>(std::max<std::size_t>(1, difference.judged.size()));
    for (ColumnDifference& column : difference.judged) column.found = welchDifference(column.a, column.b, each);
    for (ColumnDifference& column : difference.ofMachine) column.found = welchDifference(column.a, column.b, confidence);
    return difference;
}

EnsembleDifference differenceOf(const Ensemble& a, const Ensemble& b, double confidence)
{
    EnsembleDifference difference = differenceOf(columnsOf(a), columnsOf(b), confidence);
    difference.a = a.label;
    difference.b = b.label;
    difference.runsA = a.folders.size();
    difference.runsB = b.folders.size();
    return difference;
}

std::string sentenceOf(const EnsembleDifference& difference)
{
    const std::string how = fmt::format("{:.6g} % confidence in all together", 100.0 * difference.confidence);
    const std::size_t seen = difference.seen(), all = difference.judged.size();
    if (seen == 0)
        return fmt::format("No difference seen between {} and {} in {} numbers of {} and {} runs, at {}.", difference.a, difference.b, all,
                           difference.runsA, difference.runsB, how);
    const auto clearest = std::ranges::max_element(difference.judged, {}, &ColumnDifference::clearness);
    const double low = clearest->found.difference - clearest->found.margin, high = clearest->found.difference + clearest->found.margin;
    const std::string range = clearest->a.mean != 0.0 ? fmt::format("{} ({} to {})", inPercent(clearest->found.difference, clearest->a.mean),
                                                                    inPercent(low, clearest->a.mean), inPercent(high, clearest->a.mean))
                                                      : intervalOf(clearest->found);
    return fmt::format("{} differs from {} in {} of {} numbers, most clearly in {}: {:.5g} against {:.5g}, {}, at {}.", difference.b, difference.a,
                       seen, all, clearest->name, clearest->b.mean, clearest->a.mean, range, how);
}

std::string differenceTable(const EnsembleDifference& difference)
{
    std::string table = fmt::format("| number | {} | {} | difference | interval | of the first | |\n|---|---:|---:|---:|---:|---:|---|\n",
                                    markdownCell(difference.a), markdownCell(difference.b));
    for (const ColumnDifference& column : difference.judged)
        table += differenceRow(column, column.found.isSeen() ? "**differs**" : "no difference seen");
    for (const ColumnDifference& column : difference.ofMachine) table += differenceRow(column, "of the machine");
    if (!difference.constant.empty()) table += fmt::format("\nThe same in all runs of both: {}.\n", fmt::join(difference.constant, ", "));
    return table;
}

std::string differenceHeader() { return "a,b,number,runs_a,mean_a,deviation_a,runs_b,mean_b,deviation_b,difference,lowest,highest,judged,differs\n"; }

std::string differenceRows(const EnsembleDifference& difference)
{
    std::string rows;
    const auto add = [&](const ColumnDifference& c, bool isJudged) {
        std::vector<std::string> words = {difference.a, difference.b, c.name};
        for (std::string& word : words) std::ranges::replace(word, ',', ';');
        rows += fmt::format("{},{},{:.9g},{:.9g},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},{}\n", fmt::join(words, ","), c.a.count, c.a.mean,
                            c.a.deviation, c.b.count, c.b.mean, c.b.deviation, c.found.difference, c.found.difference - c.found.margin,
                            c.found.difference + c.found.margin, isJudged ? 1 : 0, isJudged && c.found.isSeen() ? 1 : 0);
    };
    for (const ColumnDifference& column : difference.judged) add(column, true);
    for (const ColumnDifference& column : difference.ofMachine) add(column, false);
    return rows;
}

}  // namespace app
