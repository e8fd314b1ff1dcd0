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
    section.needs("name", "what tables and plots call it, like {name: APIC, transfer.method: apic}");
    PrecisionChoice choice{.name = sim::readText(*section.find("name"), section.pathOf("name"))};
    if (choice.name.find_first_of(",\"\n") != std::string::npos) sim::fail(node.place, path + ".name: stands in a CSV file: no commas or quotes");
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
        sim::fail(node->place, section.pathOf(key) + ": needs a list like [{name: APIC, transfer.method: apic}]");
    Choices choices;
    for (const Node& item : node->items) choices.push_back(choiceIn(item, section.pathOf(key)));
    return choices;
}

void requireKnown(const std::string& name, const Choices& choices, const Node& node, const std::string& path)
{
    std::vector<std::string> names;
    for (const PrecisionChoice& choice : choices) names.push_back(choice.name);
    if (std::ranges::find(names, name) == names.end())
        sim::fail(node.place, fmt::format("{}: there is no {}: there are {}", path, sim::inQuotes(name), fmt::join(names, ", ")));
}

struct Axis {
    const char *plural, *single;
    Choices Precision::*choices;
    std::string PrecisionNames::*name;
};
constexpr std::array<Axis, 4> kAxes = {{{"methods", "method", &Precision::methods, &PrecisionNames::method},
                                        {"integrators", "integrator", &Precision::integrators, &PrecisionNames::integrator},
                                        {"steps", "step", &Precision::steps, &PrecisionNames::step},
                                        {"resolutions", "resolution", &Precision::resolutions, &PrecisionNames::resolution}}};

void readPublished(const Node* node, Precision& precision)
{
    if (!node) return;
    const std::string path = "precision.published";
    sim::SectionReader section(*node, path);
    sim::SectionReader::read(node, path, [](auto& v) {
        for (const char* key : {"method", "integrator", "step"}) v.other(key, "");
    });
    for (const Axis& axis : kAxes) {
        if (axis.name == &PrecisionNames::resolution) continue;
        std::string& name = precision.published.*axis.name;
        name = (precision.*axis.choices).front().name;
        section.text(axis.single, name, "");
        requireKnown(name, precision.*axis.choices, *node, section.pathOf(axis.single));
    }
}

/// Which choices `quick` names.
void readQuick(const Node* node, Precision& precision)
{
    if (!node) return;
    const std::string path = "precision.quick";
    sim::SectionReader section(*node, path);
    sim::SectionReader::read(node, path, [](auto& v) {
        for (const Axis& axis : kAxes) v.other(axis.plural, "");
    });
    for (const Axis& axis : kAxes) {
        std::vector<std::string> names;
        section.texts(axis.plural, names, "");
        if (names.empty()) continue;
        Choices& choices = precision.*axis.choices;
        for (const std::string& name : names) requireKnown(name, choices, *node, section.pathOf(axis.plural));
        for (PrecisionChoice& choice : choices) choice.isQuick = std::ranges::find(names, choice.name) != names.end();
    }
}

std::vector<Check> errorsIn(const sim::SectionReader& section, const ReadingContext& context)
{
    const Node& node = *section.find("errors");
    if (!node.isList() || node.items.empty()) sim::fail(node.place, "precision.errors: needs a list of at least one");
    std::vector<Check> errors;
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        const std::string path = fmt::format("precision.errors.{}", i);
        errors.push_back(readCheck(node.items[i], path, context, fmt::format("error {}", i + 1)));
        const Check& check = errors.back();
        if (!check.expect && !check.hasCurve())
            sim::fail(node.items[i].place, path + ": needs expect, or take: rms_error to be held against a converged run");
    }
    return errors;
}

std::string questionIn(const sim::SectionReader& section)
{
    std::string text;
    for (const char* key : {"every", "let", "flow", "errors", "energy", "converged"})
        if (const Node* node = section.find(key)) text += fmt::format("{}: {}\n", key, node->flow());
    return text;
}

}  // namespace

std::optional<Precision> readPrecision(const SceneSetup& setup)
{
    const Node* node = setup.file.root.find("precision");
    if (!node) return std::nullopt;
    sim::SectionReader section(*node, "precision");
    sim::SectionReader::read(node, "precision", [](auto& v) {
        for (const char* key : {"about", "every", "let", "flow", "errors", "energy", "decay", "speed", "methods", "integrators", "steps",
                                "resolutions", "published", "headline", "converged", "quick"})
            v.other(key, "");
    });
    auto measures = std::make_shared<Measures>(setup.scene);
    const ReadingContext context = readContext(section, setup.scene, *measures);
    section.needs("errors", "a list of what is compared, like errors: [{read: flow_error, expect: 0}]");
    Precision precision;
    precision.measures = std::move(measures);
    section.text("about", precision.about, "");
    precision.every = readInterval(section, context);
    if (const Node* at = section.find("energy")) precision.energy = readFormula(*at, "precision.energy", context.reading);
    section.flag("headline", precision.isHeadline, "");
    if (const Node* at = section.find("decay")) precision.decay = readConstant(*at, "precision.decay", context);
    if (const Node* at = section.find("speed")) precision.speed = readConstant(*at, "precision.speed", context);
    precision.errors = errorsIn(section, context);
    for (const Axis& axis : kAxes) precision.*axis.choices = choicesIn(section, axis.plural);
    readPublished(section.find("published"), precision);
    readQuick(section.find("quick"), precision);
    if (const Node* at = section.find("converged"))
        for (const sim::Override& change : sim::overridesOf(*at, {})) precision.converged.push_back(change.text());
    if (precision.needsConverged() && precision.converged.empty())
        sim::fail(node->place,
                  "precision.converged is missing: what makes the run that the others are held against, like "
                  "{time.cfl: 0.25}");
    precision.question = questionIn(section);
    return precision;
}

}  // namespace app
