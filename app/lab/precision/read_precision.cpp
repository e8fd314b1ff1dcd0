#include "app/lab/checks/read_check.h"
#include "app/lab/precision/precision.h"
#include "sim/scene/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace app {

namespace {

using sim::Node;
using Choices = std::vector<PrecisionChoice>;

PrecisionChoice choiceIn(const Node& node, const std::string& path)
{
    sim::SectionReader section(node, path);
    section.required("name", "what tables and plots call it, like {name: APIC, transfer.method: apic}");
    PrecisionChoice choice{.name = sim::readText(*section.find("name"), section.pathOf("name"))};
    if (choice.name.find_first_of(",\"\n") != std::string::npos) sim::fail(node.location, path + ".name: stands in a CSV file: no commas or quotes");
    section.number("cells", choice.cells, sim::Quantity::None, sim::Range::above(0.0), "");
    for (const sim::Override& change : sim::overridesOf(node, {"name", "cells"})) choice.sets.push_back(change.text());
    return choice;
}

/// One that changes nothing where the section says nothing.
Choices choicesIn(const sim::SectionReader& section, const char* key)
{
    const Node* node = section.find(key);
    if (!node) return {{"-"}};
    if (!node->isList() || node->items.empty())
        sim::fail(node->location, section.pathOf(key) + ": needs a list like [{name: APIC, transfer.method: apic}]");
    Choices choices;
    for (const Node& item : node->items) choices.push_back(choiceIn(item, section.pathOf(key)));
    return choices;
}

void requireKnown(const std::string& name, const Choices& choices, const Node& node, const std::string& path)
{
    std::vector<std::string> names;
    for (const PrecisionChoice& choice : choices) names.push_back(choice.name);
    if (std::ranges::find(names, name) == names.end())
        sim::fail(node.location, fmt::format("{}: there is no {}: there are {}", path, sim::inQuotes(name), fmt::join(names, ", ")));
}

struct Axis {
    const char *plural, *single;
    const char *help, *published;  ///< what the keys of both names say
    Choices Precision::*choices;
    std::string PrecisionNames::*name;
};
constexpr std::array<Axis, 4> kAxes = {
    {{"methods", "method", "Transfers to run it with, each a name and what it changes", "Name of its transfer; left out: the first",
      &Precision::methods, &PrecisionNames::method},
     {"integrators", "integrator", "Integrators to run it with, each a name and what it changes", "Name of its integrator; left out: the first",
      &Precision::integrators, &PrecisionNames::integrator},
     {"steps", "step", "Time steps to run it with, each a name and what it changes, or cells that liquid of speed crosses",
      "Name of its time step; left out: the first", &Precision::steps, &PrecisionNames::step},
     {"resolutions", "resolution", "Cells to run it with, each a name and what it changes", "", &Precision::resolutions,
      &PrecisionNames::resolution}}};

void readPublished(const Node* node, Precision& precision)
{
    if (!node) return;
    const std::string path = "precision.published";
    const auto isChosen = [](const Axis& axis) { return axis.name != &PrecisionNames::resolution; };
    for (const Axis& axis : kAxes)
        if (isChosen(axis)) precision.published.*axis.name = (precision.*axis.choices).front().name;
    sim::SectionReader::read(node, path, [&](auto& v) {
        for (const Axis& axis : kAxes)
            if (isChosen(axis)) v.text(axis.single, precision.published.*axis.name, axis.published);
    });
    for (const Axis& axis : kAxes)
        if (isChosen(axis)) requireKnown(precision.published.*axis.name, precision.*axis.choices, *node, sim::joinPath(path, axis.single));
}

/// Which choices `quick` names.
void readQuick(const Node* node, Precision& precision)
{
    if (!node) return;
    const std::string path = "precision.quick";
    std::array<std::vector<std::string>, kAxes.size()> all;
    sim::SectionReader::read(node, path, [&](auto& v) {
        for (std::size_t a = 0; a < kAxes.size(); ++a) v.texts(kAxes[a].plural, all[a], "Names of those that are run; left out: all");
    });
    for (std::size_t a = 0; a < kAxes.size(); ++a) {
        const Axis& axis = kAxes[a];
        const std::vector<std::string>& names = all[a];
        if (names.empty()) continue;
        Choices& choices = precision.*axis.choices;
        for (const std::string& name : names) requireKnown(name, choices, *node, sim::joinPath(path, axis.plural));
        for (PrecisionChoice& choice : choices) choice.isQuick = std::ranges::find(names, choice.name) != names.end();
    }
}

std::vector<Check> errorsIn(const sim::SectionReader& section, const ReadingContext& context)
{
    const Node& node = *section.find("errors");
    if (!node.isList() || node.items.empty()) sim::fail(node.location, "precision.errors: needs a list of at least one");
    std::vector<Check> errors;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const std::string path = fmt::format("precision.errors.{}", i);
        errors.push_back(readCheck(node.items[i], path, context, fmt::format("error {}", i + 1)));
        const Check& check = errors.back();
        if (!check.outside.empty()) sim::fail(node.items[i].location, path + ".outside: is for validate, which tells of measurements");
        if (check.profileAt) sim::fail(node.items[i].location, path + ".at: profiles are for validate");
        if (!check.expect && !check.hasCurve())
            sim::fail(node.items[i].location, path + ": needs expect, or take: rms_error to be held against a converged run");
    }
    return errors;
}

std::string questionIn(const sim::SectionReader& section)
{
    std::string text;
    for (const char* key : {"every", "let", "flow", "control_surfaces", "errors", "energy", "converged"})
        if (const Node* node = section.find(key)) text += fmt::format("{}: {}\n", key, node->flow());
    return text;
}

}  // namespace

std::optional<Precision> readPrecision(const LoadedScene& setup)
{
    const Node* node = setup.file.root.find("precision");
    if (!node) return std::nullopt;
    Precision precision;
    sim::SectionReader::read(node, "precision", [&](auto& v) {
        v.text("about", precision.about, "What is compared with what, as the report says it");
        v.formula("every", "Time between two readings [s], above 0");
        describeContext(v);
        v.other("errors", "What is compared; the error of a run is the root mean square of these");
        v.formula("energy", "Energy of which the table tells how much is left");
        v.formula("decay", "Rate at which that energy decays over the kinematic viscosity, 0 where it is not known [1/cm^2]");
        v.formula("speed", "Speed of the liquid, for steps that are told in cells [cm/s]");
        for (const Axis& axis : kAxes) v.other(axis.plural, axis.help);
        v.other("published", "The scheme to compare with");
        v.flag("headline", precision.isHeadline, "It is drawn beside the other such cases");
        v.other("converged", "What makes the run that the others are held against where no formula is known");
        v.other("quick", "What drench bench precision --quick runs");
    });
    sim::SectionReader section(*node, "precision");
    auto measures = std::make_shared<Measures>(setup.scene);
    const ReadingContext context = readContext(section, setup.scene, *measures);
    section.required("errors", "a list of what is compared, like errors: [{read: flow_error, expect: 0}]");
    precision.measures = std::move(measures);
    precision.every = readInterval(section, context);
    if (const Node* at = section.find("energy")) precision.energy = readFormula(*at, "precision.energy", context.reading);
    if (const Node* at = section.find("decay")) precision.decay = readConstant(*at, "precision.decay", context);
    if (const Node* at = section.find("speed")) precision.speed = readConstant(*at, "precision.speed", context);
    precision.errors = errorsIn(section, context);
    for (const Axis& axis : kAxes) precision.*axis.choices = choicesIn(section, axis.plural);
    readPublished(section.find("published"), precision);
    readQuick(section.find("quick"), precision);
    if (const Node* at = section.find("converged")) {
        if (!at->isMap()) sim::fail(at->location, fmt::format("precision.converged: needs a map like {{time.cfl: 0.25}}, not {}", at->called()));
        for (const sim::Override& change : sim::overridesOf(*at, {})) precision.converged.push_back(change.text());
    }
    if (precision.needsConverged() && precision.converged.empty())
        sim::fail(node->location,
                  "precision.converged is missing: what makes the run that the others are held against, like "
                  "{time.cfl: 0.25}");
    precision.question = questionIn(section);
    return precision;
}

}  // namespace app
