#include "app/lab/precision/precision.h"
#include "app/lab/validation/validation.h"
#include "app/probes/probes.h"
#include "app/scene/describe_picture.h"
#include "app/schema/ask_reader.h"
#include "app/schema/body_schemas.h"
#include "app/schema/schema.h"
#include "app/study/study.h"
#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/read_changes.h"

#include <fmt/format.h>

namespace app {

namespace {

using sim::DeclaredKey;
using sim::KeyList;
using sim::Node;

constexpr const char* kDraft = "http://json-schema.org/draft-07/schema#";

/// What sections are for, and lists and maps that take their place.
constexpr KeyMeaning kSections[] = {
    {"scene", "What the scene is called"},
    {"time", "Steps, and how long it runs"},
    {"transfer", "How velocities go between particles and grid; a word alone is the method"},
    {"grid", "The grid"},
    {"coupling", "What liquid and fabric do to each other"},
    {"solver", "How exactly equations are solved"},
    {"porous", "Pores of all fabric"},
    {"fabric", "How fabric is simulated"},
    {"liquid", "The liquid, and where it starts"},
    {"materials", "Materials of fabrics, by names of your own"},
    {"fabrics", "Pieces of fabric"},
    {"obstacles", "Solid bodies"},
    {"domain", "Where liquid may be: what leaves it is deleted and told"},
    {"motion", "Motions of obstacles, fabrics, groups and pins, by their names"},
    {"changes", "Settings that change on the way"},
    {"render", "How pictures look"},
    {"output", "What a run writes"},
    {"compare", "Which runs are compared, and how"},
    {"validate", "Known answers that a run is held against"},
    {"precision", "A case of drench bench precision"},
};

template <class Fields>
SchemaJson declaredMap(Fields fields)
{
    KeyList list;
    fields(list);
    return mapSchema(list.keys, SchemaOf::Section);
}

/// Dotted keys of a scene, or sections, each with a value.
SchemaJson settingsSchema() { return {{"type", "object"}, {"propertyNames", {{"pattern", "^[^=]+$"}}}}; }

/// A list of maps that give dotted keys values, or a map of dotted keys to lists of values.
SchemaJson variantsSchema() { return {{"anyOf", {listSchema(settingsSchema(), 1), namedSchema(listSchema(SchemaJson::object(), 1))}}}; }

SchemaJson liquidSchema()
{
    sim::LiquidSettings values;
    SchemaJson schema = declaredMap([&](KeyList& v) { visitFields(v, values); });
    SchemaJson presets = SchemaJson::array();
    for (const sim::LiquidPreset& preset : sim::liquidPresets()) presets.push_back(preset.name);
    presets.push_back("none");
    schema["properties"]["preset"]["enum"] = presets;
    schema["properties"]["sources"].update(listSchema(definitionOf("source")));
    schema["properties"]["openings"].update(listSchema(definitionOf("opening")));
    return schema;
}

SchemaJson materialsSchema()
{
    sim::FabricMaterial values;
    SchemaJson schema = declaredMap([&](KeyList& v) { visitFields(v, values); });
    schema["properties"]["preset"]["enum"] = sim::fabricPresetNames();
    return namedSchema(schema);
}

SchemaJson compareSchema()
{
    CompareSettings values;
    SchemaJson schema = declaredMap([&](KeyList& v) { visitFields(v, values); });
    schema["properties"]["variants"].update(variantsSchema());
    return schema;
}

SchemaJson changesSchema()
{
    const auto keys = keysReadBy("changes: [{}]", [](const Node& node) { sim::readChanges(node, {}); });
    SchemaJson change = mapSchema(keys, SchemaOf::Body);
    change["properties"]["set"].update(settingsSchema());
    return listSchema(change);
}

/// Keys of the last map that the reader of a section comes to: what stands behind them are words and formulas.
template <class Read>
SchemaJson lastKeyRead(const std::string& text, Read read)
{
    LoadedScene setup;
    return mapSchema(keysReadBy(text,
                                [&](const Node& node) {
                                    setup.file.root = node;
                                    read(setup);
                                }),
                     SchemaOf::Body);
}

/// What sections with formulas have in common.
void addContext(SchemaJson& section)
{
    section["properties"]["let"].update(namedSchema(formulaSchema()));
    SchemaJson three = listSchema(formulaSchema(), sim::kAxes);
    three["maxItems"] = sim::kAxes;
    section["properties"]["flow"].update(three);
    section["properties"]["control_surfaces"].update(
        namedSchema(lastKeyRead("output: {probes: {control_surfaces: {a: {}}, readings: []}}", readProbes)));
}

/// Rows of two numbers, or of four with a band.
SchemaJson tableSchema()
{
    const SchemaJson number = {{"anyOf", {{{"type", "number"}}, {{"type", "string"}}}}};
    const auto rowsOf = [&](int count) { return listSchema({{"type", "array"}, {"items", number}, {"minItems", count}, {"maxItems", count}}, 1); };
    return {{"anyOf", {rowsOf(2), rowsOf(4)}}};
}

/// @param list  of what is read as the scene runs
template <class Read>
SchemaJson readingsSchema(const std::string& section, const std::string& list, Read read)
{
    SchemaJson schema = lastKeyRead(section + ": {}", read);
    SchemaJson reading = lastKeyRead(section + ": {every: 1, " + list + ": [{}]}", read);
    reading["properties"]["table"].update(tableSchema());
    schema["properties"][list].update(listSchema(reading));
    addContext(schema);
    return schema;
}

SchemaJson probesSchema()
{
    const auto within = [](const std::string& probes) { return lastKeyRead("output: {probes: {" + probes + "}}", readProbes); };
    SchemaJson schema = within(""), reading = within("readings: [{}]");
    addContext(schema);
    reading["properties"]["along"].update(within("readings: [{read: 1, along: {}}]"));
    schema["properties"]["readings"].update(listSchema(reading, 1));
    return schema;
}

SchemaJson outputSchema()
{
    OutputSettings values;
    SchemaJson schema = declaredMap([&](KeyList& v) { visitFields(v, values); });
    schema["properties"]["probes"].update(probesSchema());
    return schema;
}

SchemaJson validateSchema()
{
    SchemaJson schema = readingsSchema("validate", "checks", readValidation);
    schema["properties"]["quick"].update(settingsSchema());
    return schema;
}

SchemaJson precisionSchema()
{
    SchemaJson schema = readingsSchema("precision", "errors", readPrecision);
    schema["properties"]["converged"].update(settingsSchema());
    for (const char* key : {"methods", "integrators", "steps", "resolutions"}) schema["properties"][key].update(listSchema(settingsSchema(), 1));
    for (const char* key : {"published", "quick"})
        schema["properties"][key].update(
            lastKeyRead(fmt::format("precision: {{every: 1, errors: [{{read: t, expect: 1}}], {}: {{}}}}", key), readPrecision));
    return schema;
}

SchemaJson sceneProperties()
{
    sim::Settings settings;
    sim::Scene scene;
    RenderSettings render;
    KeyList top;
    visitFields(top, settings);
    describeFabric(top, settings);
    SchemaJson properties = {
        {"drench", {{"const", 1}, {"description", "Schema version"}}},
        {"units", {{"enum", {"cgs", "si"}}, {"default", "cgs"}, {"description", "Of bare numbers in this file"}}},
        {"include", {{"type", {"string", "array"}}, {"items", {{"type", "string"}}}, {"description", "Scene files that this one is laid over"}}},
        {"scene", declaredMap([&](KeyList& v) { describeNames(v, scene); })}};
    properties.update(mapSchema(top.keys, SchemaOf::Section)["properties"]);
    SchemaJson& transfer = properties["transfer"];
    const SchemaJson method = transfer["properties"]["method"];
    transfer = {{"anyOf", {method, transfer}}};
    properties.update({{"liquid", liquidSchema()},
                       {"materials", materialsSchema()},
                       {"fabrics", listSchema(definitionOf("fabric"))},
                       {"obstacles", listSchema(definitionOf("obstacle"))},
                       {"domain", definitionOf("shape")},
                       {"motion", {{"anyOf", {namedSchema(definitionOf("motion")), listSchema(definitionOf("named_motion_piece"))}}}},
                       {"changes", changesSchema()},
                       {"render", declaredMap([&](KeyList& v) { visitFields(v, render); })},
                       {"output", outputSchema()},
                       {"compare", compareSchema()},
                       {"validate", validateSchema()},
                       {"precision", precisionSchema()}});
    addMeanings(kSections, properties);
    return properties;
}

}  // namespace

/// A file that includes others need not say what they do: nothing is required of a whole one.
std::string sceneSchema()
{
    const SchemaJson schema = {{"$schema", kDraft},
                               {"title", "Drench scene"},
                               {"type", "object"},
                               {"properties", sceneProperties()},
                               {"additionalProperties", false},
                               {"definitions", bodyDefinitions()}};
    return schema.dump(1) + '\n';
}

std::string studySchema()
{
    SchemaJson schema = {{"$schema", kDraft}, {"title", "Drench study"}};
    StudyFields values;
    schema.update(declaredMap([&](KeyList& v) { visitFields(v, values); }));
    schema["properties"]["set"].update(settingsSchema());
    schema["properties"]["runs"].update(variantsSchema());
    schema["required"] = {"scene", "runs"};
    return schema.dump(1) + '\n';
}

}  // namespace app
