#include "app/lab/validation.h"
#include "sim/scene/overrides.h"
#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

using sim::Node;

/// What formulas may use, and where the section stands.
struct Context {
    sim::FormulaNames reading;  ///< of what is read: measures and the time
    sim::FormulaNames known;    ///< of what is expected: the time
    sim::FormulaNames constant;
};

sim::Formula formulaIn(const Node& node, const std::string& path, const sim::FormulaNames& names)
{
    const std::string& text = sim::readText(node, path);
    try {
        return sim::Formula(text, names);
    } catch (const sim::FormulaError& error) {
        sim::fail(node.place, fmt::format("{}: {}: {}", path, sim::inQuotes(text), error.what()));
    }
}

double constantIn(const Node& node, const std::string& path, const Context& context)
{
    const sim::Formula formula = formulaIn(node, path, context.constant);
    try {
        return formula();
    } catch (const sim::FormulaError& error) {
        sim::fail(node.place, fmt::format("{}: {}: {}", path, sim::inQuotes(formula.text()), error.what()));
    }
}

void define(const std::string& name, double value, Context& context)
{
    for (sim::FormulaNames* names : {&context.reading, &context.known, &context.constant})
        names->constants[name] = value;
}

/// What formulas know of the scene: g, density, viscosity, surface_tension, dx, and duration.
Context contextOf(const sim::Scene& scene)
{
    Context context;
    context.reading.variables = context.known.variables = {"t"};
    const sim::Settings& s = scene.settings;
    define("g", s.gravity.norm(), context);
    define("density", s.liquid.density, context);
    define("viscosity", s.liquid.viscosity, context);
    define("surface_tension", s.liquid.surfaceTension, context);
    define("dx", s.cell, context);
    define("duration", s.time.duration, context);
    return context;
}

void readConstants(const Node* let, Context& context)
{
    if (!let) return;
    if (!let->isMap())
        sim::fail(let->place, "validate.let: needs names and formulas, like {k: pi/10}, not " + let->called());
    for (std::size_t i = 0; i < let->keys.size(); ++i)
        define(let->keys[i], constantIn(let->items[i], "validate.let." + let->keys[i], context), context);
}

void readFlow(const Node* node, const Context& context, Measures& measures)
{
    if (!node) return;
    const std::string path = "validate.flow";
    sim::FormulaNames names = context.constant;
    names.variables = {"x", "y", "z", "t"};
    if (!node->isList() || node->items.size() != sim::kAxes)
        sim::fail(node->place, path + ": needs three formulas of x, y, z, t like [\"-y\", \"x\", \"0\"]");
    const auto at = [&](std::size_t i) { return formulaIn(node->items[i], path, names); };
    measures.setFlow({at(0), at(1), at(2)});
}

Take takeIn(const Node& node, const std::string& path)
{
    const std::vector<std::string> words(kTakes.begin(), kTakes.end());
    return static_cast<Take>(sim::readChoice(node, path, words, std::vector<bool>(words.size(), true)));
}

std::vector<std::array<double, 2>> tableIn(const Node& node, const std::string& path)
{
    if (!node.isList() || node.items.empty())
        sim::fail(node.place, path + ": needs pairs of numbers, like [[0, 1], [0.5, 1.2]]");
    std::vector<std::array<double, 2>> table;
    for (const Node& row : node.items)
        sim::readNumbers(row, path, table.emplace_back(), sim::Quantity::None, sim::Range::any());
    if (!std::ranges::is_sorted(table, {}, [](const auto& row) { return row[0]; }))
        sim::fail(node.place, path + ": its first numbers must ascend");
    return table;
}

/// What is missing for the check to be able to fail.
void requireVerdict(const Check& check, const Node& node, const std::string& path)
{
    const bool expects = check.expect || !check.table.empty(), hasTolerance = check.tolerance || check.within,
               hasBound = check.atMost || check.atLeast;
    if (check.hasCurve() && (!expects || !hasBound))
        sim::fail(node.place, path + ": an error needs expect or table, and at_most");
    if (check.hasCurve()) return;
    if (!check.table.empty())
        sim::fail(node.place, path + ": a table is compared by take: mean_error or largest_error");
    if (check.expect && !hasTolerance)
        sim::fail(node.place, path + ": expect needs tolerance (relative) or within (absolute)");
    if (!expects && !hasBound) sim::fail(node.place, path + ": needs expect with a tolerance, at_most, or at_least");
}

Check checkIn(const Node& node, std::size_t index, const Context& context)
{
    std::string path = fmt::format("validate.checks.{}", index);
    sim::SectionReader section(node, path);
    sim::SectionReader::read(&node, path, [](auto& v) {
        for (const char* key : {"name", "unit", "read", "against", "from", "to", "take", "level", "expect", "table",
                                "tolerance", "within", "at_most", "at_least"})
            v.other(key, "");
    });
    section.needs("read", "a formula of what is read as the scene runs, like read: liquid_y");
    const auto readings = [&](const char* key, const char* otherwise) {
        const Node* at = section.find(key);
        return at ? formulaIn(*at, section.pathOf(key), context.reading) : sim::Formula(otherwise, context.reading);
    };
    const auto constant = [&](const char* key) -> std::optional<double> {
        const Node* at = section.find(key);
        return at ? std::optional(constantIn(*at, section.pathOf(key), context)) : std::nullopt;
    };
    Check check{
        .name = fmt::format("check {}", index + 1), .read = readings("read", ""), .against = readings("against", "t")};
    section.text("name", check.name, "");
    section.text("unit", check.unit, "");
    check.from = constant("from").value_or(check.from);
    check.to = constant("to").value_or(check.to);
    check.level = constant("level").value_or(check.level);
    if (const Node* at = section.find("take")) check.take = takeIn(*at, section.pathOf("take"));
    if (const Node* at = section.find("expect")) check.expect = formulaIn(*at, section.pathOf("expect"), context.known);
    if (const Node* at = section.find("table")) check.table = tableIn(*at, section.pathOf("table"));
    check.tolerance = constant("tolerance");
    check.within = constant("within");
    check.atMost = constant("at_most");
    check.atLeast = constant("at_least");
    requireVerdict(check, node, path);
    return check;
}

}  // namespace

std::optional<Validation> readValidation(const sim::SceneFile& file, const sim::Scene& scene)
{
    const Node* node = file.root.find("validate");
    if (!node) return std::nullopt;
    sim::SectionReader section(*node, "validate");
    sim::SectionReader::read(node, "validate", [](auto& v) {
        for (const char* key : {"about", "source", "every", "let", "flow", "quick", "checks"}) v.other(key, "");
    });
    Validation validation;
    validation.measures = std::make_shared<Measures>(scene.settings.liquid.density);
    section.text("about", validation.about, "");
    section.text("source", validation.source, "");
    Context context = contextOf(scene);
    readConstants(section.find("let"), context);
    section.needs("every", "the time between two readings, like every: 1.0e-2");
    validation.every = constantIn(*section.find("every"), "validate.every", context);
    if (validation.every <= 0.0) sim::fail(section.placeOf("every"), "validate.every: must be above 0 s");
    readFlow(section.find("flow"), context, *validation.measures);
    context.reading.functions = validation.measures->names();
    if (const Node* quick = section.find("quick"))
        for (const sim::Override& change : sim::overridesOf(*quick, {})) validation.quick.push_back(change.text());
    section.needs("checks", "a list of what is compared, like checks: [{read: liquid_y, expect: 1, tolerance: 0.01}]");
    const Node& checks = *section.find("checks");
    if (!checks.isList() || checks.items.empty())
        sim::fail(checks.place, "validate.checks: needs a list of at least one check");
    for (std::size_t i = 0; i < checks.items.size(); ++i)
        validation.checks.push_back(checkIn(checks.items[i], i, context));
    return validation;
}

}  // namespace app
