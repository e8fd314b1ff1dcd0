#include "app/ensemble/difference.h"

#include "app/system/markdown.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace app {

namespace {

/// Numbers that differ by less are the same, relative to the largest of their kind: logs have twelve digits.
constexpr double kSameWithin = 1.0e-11;

/// Pairs that differ by less, relative to their numbers, do so by rounding.
constexpr double kPairsSameWithin = 1.0e-9;

/// Share of the probability of an error that pairs may use: Student's interval is for normal numbers, and among 20 drawn evenly or of two values it
/// seems to find a difference in 1.25 and 1.35 % of cases where 1 % was asked for. Welch's with the fewest degrees of freedom needs no reserve.
constexpr double kShareOfPairs = 0.5;

/// Numbers of one unit: "erg" of "kinetic_erg, mean", "[cm]" of "height [cm], mean".
std::string kindOf(const std::string& column)
{
    const std::string name = column.substr(0, column.rfind(", "));
    const std::size_t unit = name.rfind(" [");
    return name.substr(unit != std::string::npos ? unit + 1 : name.rfind('_') + 1);
}

/// The largest number of each kind, by size.
std::map<std::string, double> scalesOf(const std::vector<EnsembleColumn>& a, const std::vector<EnsembleColumn>& b)
{
    std::map<std::string, double> scales;
    for (const auto* columns : {&a, &b})
        for (const EnsembleColumn& column : *columns) {
            const Spread s = column.spread();
            double& scale = scales[kindOf(column.name)];
            if (s.count > 0) scale = std::max({scale, std::abs(s.lowest), std::abs(s.highest)});
        }
    return scales;
}

bool isConstant(const Spread& a, const Spread& b, double scale)
{
    return std::max(a.highest, b.highest) - std::min(a.lowest, b.lowest) <= kSameWithin * scale;
}

/// Do all pairs have two numbers that are the same?
bool arePairsSame(const EnsembleColumn& a, const EnsembleColumn& b, double scale)
{
    double largest = 0.0, difference = 0.0;
    for (std::size_t n = 0; n < a.values.size(); ++n) {
        if (!std::isfinite(a.values[n]) || !std::isfinite(b.values[n])) continue;
        largest = std::max({largest, std::abs(a.values[n]), std::abs(b.values[n])});
        difference = std::max(difference, std::abs(b.values[n] - a.values[n]));
    }
    return difference <= std::max(kPairsSameWithin * largest, kSameWithin * scale);
}

/// Adds a column by its name in the log, once; what is 0 everywhere is not worth a word.
void addConstant(const EnsembleColumn& column, std::vector<std::string>& constant)
{
    const std::string name = column.name.substr(0, column.name.rfind(", "));
    if (column.spread().mean != 0.0 && std::ranges::find(constant, name) == constant.end()) constant.push_back(name);
}

/// "+1.2 %" of a mean, or nothing where that is next to 0.
std::string inPercent(double part, const Spread& whole)
{
    return whole.isAwayFromZero() ? fmt::format("{:+.3g} %", 100.0 * part / std::abs(whole.mean)) : "";
}

/// "1.2 to 3.4", or nothing where there are too few runs.
std::string intervalOf(const MeanDifference& found)
{
    if (!std::isfinite(found.margin)) return "too few runs";
    return fmt::format("{:.4g} to {:.4g}", found.difference - found.margin, found.difference + found.margin);
}

std::string differenceRow(const ColumnDifference& column, const std::string& verdict)
{
    return fmt::format("| {} | {} | {} | {:.4g} | {} | {} | {} |\n", markdownCell(column.name), textOf(column.a), textOf(column.b),
                       column.found.difference, intervalOf(column.found), inPercent(column.found.difference, column.a), verdict);
}

/// A number of two ensembles that is to be compared.
struct Compared {
    const EnsembleColumn &a, &b;

    ColumnDifference difference(double confidence, bool isPaired) const
    {
        const Spread spreadA = a.spread(), spreadB = b.spread();
        return {a.name, spreadA, spreadB,
                isPaired ? pairedDifference(a.values, b.values, confidence) : welchDifference(spreadA, spreadB, confidence)};
    }
};

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// Runs of the two with the same draw.
Pairs pairsOf(const Ensemble& a, const Ensemble& b)
{
    Pairs pairs;
    for (std::size_t n = 0; n < a.runs.size(); ++n) {
        const auto like = std::ranges::find(b.runs, a.runs[n].draw, &EnsembleRun::draw);
        if (like != b.runs.end()) pairs.emplace_back(n, static_cast<std::size_t>(like - b.runs.begin()));
    }
    return pairs;
}

/// Columns with the values of runs that have a pair alone, in the order of the pairs.
std::vector<EnsembleColumn> inOrder(std::vector<EnsembleColumn> columns, const Pairs& pairs, std::size_t std::pair<std::size_t, std::size_t>::*of)
{
    for (EnsembleColumn& column : columns) {
        std::vector<double> values;
        for (const auto& pair : pairs) values.push_back(column.values[pair.*of]);
        column.values = std::move(values);
    }
    return columns;
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

EnsembleDifference differenceOf(const std::vector<EnsembleColumn>& a, const std::vector<EnsembleColumn>& b, double confidence, bool isPaired)
{
    EnsembleDifference difference;
    difference.confidence = confidence;
    difference.isPaired = isPaired;
    const std::map<std::string, double> scales = scalesOf(a, b);
    std::vector<Compared> judged, ofMachine;
    for (const EnsembleColumn& inA : a) {
        const auto inB = std::ranges::find(b, inA.name, &EnsembleColumn::name);
        if (inB == b.end() || inA.spread().count == 0 || inB->spread().count == 0) continue;
        const double scale = scales.at(kindOf(inA.name));
        if (inA.isOfMachine) ofMachine.push_back({inA, *inB});
        else if (isConstant(inA.spread(), inB->spread(), scale) || (isPaired && arePairsSame(inA, *inB, scale)))
            addConstant(inA, difference.constant);
        else judged.push_back({inA, *inB});
    }
    const double error = (isPaired ? kShareOfPairs : 1.0) * (1.0 - confidence);
    const double each = 1.0 - error / static_cast<double>(std::max<std::size_t>(1, judged.size()));
    for (const Compared& compared : judged) difference.judged.push_back(compared.difference(each, isPaired));
    for (const Compared& compared : ofMachine) difference.ofMachine.push_back(compared.difference(confidence, isPaired));
    return difference;
}

EnsembleDifference differenceOf(const Ensemble& a, const Ensemble& b, double confidence)
{
    const auto pairs = pairsOf(a, b);
    const bool isPaired = pairs.size() >= 2 && pairs.size() == std::min(a.runs.size(), b.runs.size());
    std::vector<EnsembleColumn> columnsA = columnsOf(a), columnsB = columnsOf(b);
    if (isPaired) {
        columnsA = inOrder(std::move(columnsA), pairs, &std::pair<std::size_t, std::size_t>::first);
        columnsB = inOrder(std::move(columnsB), pairs, &std::pair<std::size_t, std::size_t>::second);
    }
    EnsembleDifference difference = differenceOf(columnsA, columnsB, confidence, isPaired);
    difference.a = a.label;
    difference.b = b.label;
    difference.runsA = isPaired ? pairs.size() : a.runs.size();
    difference.runsB = isPaired ? pairs.size() : b.runs.size();
    return difference;
}

std::string sentenceOf(const EnsembleDifference& difference)
{
    const std::string runs =
        difference.isPaired ? fmt::format("{} pairs of runs", difference.runsA) : fmt::format("{} and {} runs", difference.runsA, difference.runsB);
    const std::string how = fmt::format("of {}, at {:.6g} % confidence in all together", runs, 100.0 * difference.confidence);
    const std::size_t seen = difference.seen(), all = difference.judged.size();
    if (all == 0) return fmt::format("No difference seen between {} and {}: all numbers of {} are the same.", difference.a, difference.b, runs);
    const std::string numbers = all == 1 ? "1 number" : fmt::format("{} numbers", all);
    if (seen == 0) return fmt::format("No difference seen between {} and {} in {} {}.", difference.a, difference.b, numbers, how);
    const auto clearest = std::ranges::max_element(difference.judged, {}, &ColumnDifference::clearness);
    const double low = clearest->found.difference - clearest->found.margin, high = clearest->found.difference + clearest->found.margin;
    const std::string range = clearest->a.isAwayFromZero() ? fmt::format("{} ({} to {})", inPercent(clearest->found.difference, clearest->a),
                                                                         inPercent(low, clearest->a), inPercent(high, clearest->a))
                                                           : "a difference of " + intervalOf(clearest->found);
    return fmt::format("{} differs from {} in {} of {}, most clearly in {}: {:.5g} against {:.5g}, {}, {}.", difference.b, difference.a, seen, all,
                       clearest->name, clearest->b.mean, clearest->a.mean, range, how);
}

std::string differenceTable(const EnsembleDifference& difference)
{
    std::string table = fmt::format(
        "| number | {}: mean ± deviation | {}: mean ± deviation | difference | interval | of the first | |\n|---|---:|---:|---:|---:|---:|---|\n",
        markdownCell(difference.a), markdownCell(difference.b));
    for (const ColumnDifference& column : difference.judged)
        table += differenceRow(column, column.found.isSeen() ? "**differs**" : "no difference seen");
    for (const ColumnDifference& column : difference.ofMachine) table += differenceRow(column, "of the machine");
    if (!difference.constant.empty())
        table += fmt::format("\nThe same in {}: {}.\n", difference.isPaired ? "both runs of each pair" : "all runs of both",
                             fmt::join(difference.constant, ", "));
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
