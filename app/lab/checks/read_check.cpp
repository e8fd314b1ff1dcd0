#include "app/lab/checks/read_check.h"

#include <algorithm>
#include <array>
#include <span>

namespace app {

namespace {

using sim::Node;

Known rowIn(const Node& node, const std::string& path, bool hasBand)
{
    std::array<double, 4> row = {};
    const auto numbers = std::span(row).first(hasBand ? 4 : 2);
    sim::readNumbers(node, path, numbers, sim::Quantity::None, sim::Range::any());
    if (!hasBand) return {.at = row[0], .value = row[1]};
    if (row[2] > row[1] || row[1] > row[3])
        sim::fail(node.location, path + ": a row with a band is [against, value, lower, upper], lower <= value <= upper");
    return {.at = row[0], .value = row[1], .lower = row[2], .upper = row[3]};
}

std::vector<Known> tableIn(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.empty())
        sim::fail(node.location,
                  path + ": needs pairs of numbers, like [[0, 1], [0.5, 1.2]], or with a band [[0, 1, 0.9, 1.1], [0.5, 1.2, 1.1, 1.4]]");
    const bool hasBand = node.items.front().isList() && node.items.front().items.size() == 4;
    std::vector<Known> table;
    for (const Node& row : node.items) table.push_back(rowIn(row, path, hasBand));
    if (!std::ranges::is_sorted(table, {}, &Known::at)) sim::fail(node.location, path + ": its first numbers must ascend");
    return table;
}

}  // namespace

Check readCheck(const Node& node, const std::string& path, const ReadingContext& context, const std::string& name)
{
    std::string called = name, unit, outside;
    Statistic statistic = Statistic::Last;
    sim::SectionReader::read(&node, path, [&](auto& v) {
        v.text("name", called, "What tables and plots call it");
        v.text("unit", unit, "As tables and plots show it");
        v.required("read", "a formula of what is read as the scene runs, like read: liquid_y");
        v.formula("read", "What is read as the scene runs, of t and the names of app/readings/measures.h");
        v.formula("against", "What readings are ordered by; left out: the time t");
        v.formula("from", "Readings below it, of against, do not count");
        v.formula("to", "Readings above it, of against, do not count");
        v.choice("take", statistic, "The one number that is made of the readings; left out: last");
        v.formula("level", "Which take: reach is about");
        v.formula("expect", "What is known, of the time t");
        v.other("table", "What was measured, in the place of expect: against, value and, where its scatter is known, its lower and upper end");
        v.formula("tolerance", "Largest difference from expect, relative to it");
        v.formula("within", "Largest difference from expect, as it is");
        v.formula("at_most", "Largest value");
        v.formula("at_least", "Smallest value");
        v.formula("at", "Time at which a profile is read, at the places s of the table; read is then a formula of s, too [s]");
        v.formula("otherwise", "What counts where a reading has no value, like a height where nothing is wet; left out: the run fails there");
        v.text("outside", outside, "Why what is found is known to be outside of what was measured: it is told and fails nothing");
    });
    const sim::SectionReader section(node, path);
    sim::FormulaNames names = context.reading;
    if (section.find("at")) names.variables.emplace_back("s");
    const auto readings = [&](const char* key, const char* otherwise) {
        const Node* at = section.find(key);
        return at ? readFormula(*at, section.pathOf(key), names) : sim::Formula(otherwise, names);
    };
    const auto constant = [&](const char* key) -> std::optional<double> {
        const Node* at = section.find(key);
        return at ? std::optional(readConstant(*at, section.pathOf(key), context)) : std::nullopt;
    };
    Check check{.name = called, .read = readings("read", ""), .against = readings("against", "t"), .statistic = statistic, .unit = unit};
    check.from = constant("from").value_or(check.from);
    check.to = constant("to").value_or(check.to);
    check.level = constant("level").value_or(check.level);
    if (const Node* at = section.find("expect")) check.expect = readFormula(*at, section.pathOf("expect"), context.known);
    if (const Node* at = section.find("table")) check.table = tableIn(*at, section.pathOf("table"));
    check.tolerance = constant("tolerance");
    check.within = constant("within");
    check.atMost = constant("at_most");
    check.atLeast = constant("at_least");
    check.otherwise = constant("otherwise");
    check.outside = outside;
    check.profileAt = constant("at");
    const auto isGiven = [&](const char* key) { return section.find(key) != nullptr; };
    if (check.profileAt && (!isGiven("table") || std::ranges::any_of(std::array{"against", "from", "to", "expect"}, isGiven)))
        sim::fail(section.locationOf("at"),
                  section.pathOf("at") + ": a profile needs a table of its places and values, and no against, from, to or expect");
    return check;
}

}  // namespace app
