#include "app/lab/checks/read_check.h"

#include <algorithm>
#include <array>

namespace app {

namespace {

using sim::Node;

std::vector<std::array<double, 2>> tableIn(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.empty()) sim::fail(node.location, path + ": needs pairs of numbers, like [[0, 1], [0.5, 1.2]]");
    std::vector<std::array<double, 2>> table;
    for (const Node& row : node.items) sim::readNumbers(row, path, table.emplace_back(), sim::Quantity::None, sim::Range::any());
    if (!std::ranges::is_sorted(table, {}, [](const auto& row) { return row[0]; }))
        sim::fail(node.location, path + ": its first numbers must ascend");
    return table;
}

}  // namespace

Check readCheck(const Node& node, const std::string& path, const ReadingContext& context, const std::string& name)
{
    std::string called = name, unit;
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
        v.other("table", "What was measured, in the place of expect: pairs of against and the value, against ascending");
        v.formula("tolerance", "Largest difference from expect, relative to it");
        v.formula("within", "Largest difference from expect, as it is");
        v.formula("at_most", "Largest value");
        v.formula("at_least", "Smallest value");
    });
    const sim::SectionReader section(node, path);
    const auto readings = [&](const char* key, const char* otherwise) {
        const Node* at = section.find(key);
        return at ? readFormula(*at, section.pathOf(key), context.reading) : sim::Formula(otherwise, context.reading);
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
    return check;
}

}  // namespace app
