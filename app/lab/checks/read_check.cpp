#include "app/lab/checks/read_check.h"

#include <algorithm>
#include <array>

namespace app {

namespace {

using sim::Node;

Take takeIn(const Node& node, const std::string& path)
{
    const std::vector<std::string> words(kTakes.begin(), kTakes.end());
    return static_cast<Take>(sim::readChoice(node, path, words));
}

std::vector<std::array<double, 2>> tableIn(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.empty()) sim::fail(node.place, path + ": needs pairs of numbers, like [[0, 1], [0.5, 1.2]]");
    std::vector<std::array<double, 2>> table;
    for (const Node& row : node.items) sim::readNumbers(row, path, table.emplace_back(), sim::Quantity::None, sim::Range::any());
    if (!std::ranges::is_sorted(table, {}, [](const auto& row) { return row[0]; })) sim::fail(node.place, path + ": its first numbers must ascend");
    return table;
}

}  // namespace

Check readCheck(const Node& node, const std::string& path, const ReadingContext& context, const std::string& name)
{
    sim::SectionReader section(node, path);
    sim::SectionReader::read(&node, path, [](auto& v) {
        for (const char* key :
             {"name", "unit", "read", "against", "from", "to", "take", "level", "expect", "table", "tolerance", "within", "at_most", "at_least"})
            v.other(key, "");
    });
    section.needs("read", "a formula of what is read as the scene runs, like read: liquid_y");
    const auto readings = [&](const char* key, const char* otherwise) {
        const Node* at = section.find(key);
        return at ? readFormula(*at, section.pathOf(key), context.reading) : sim::Formula(otherwise, context.reading);
    };
    const auto constant = [&](const char* key) -> std::optional<double> {
        const Node* at = section.find(key);
        return at ? std::optional(readConstant(*at, section.pathOf(key), context)) : std::nullopt;
    };
    Check check{.name = name, .read = readings("read", ""), .against = readings("against", "t")};
    section.text("name", check.name, "");
    section.text("unit", check.unit, "");
    check.from = constant("from").value_or(check.from);
    check.to = constant("to").value_or(check.to);
    check.level = constant("level").value_or(check.level);
    if (const Node* at = section.find("take")) check.take = takeIn(*at, section.pathOf("take"));
    if (const Node* at = section.find("expect")) check.expect = readFormula(*at, section.pathOf("expect"), context.known);
    if (const Node* at = section.find("table")) check.table = tableIn(*at, section.pathOf("table"));
    check.tolerance = constant("tolerance");
    check.within = constant("within");
    check.atMost = constant("at_most");
    check.atLeast = constant("at_least");
    return check;
}

}  // namespace app
