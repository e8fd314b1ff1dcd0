#include "app/schema/body_schemas.h"

#include "app/schema/ask_reader.h"
#include "sim/scene/describe.h"
#include "sim/scene/describe_fabric.h"
#include "sim/scene/read_bodies.h"
#include "sim/scene/read_fabrics.h"
#include "sim/scene/read_place.h"
#include "sim/scene/read_shape.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

using sim::DeclaredKey;
using sim::Node;

constexpr KeyMeaning kShapeKinds[] = {
    {"box", "A box along the axes"},
    {"rounded_box", "A box with round edges"},
    {"ball", "A ball"},
    {"capsule", "All that is near a line"},
    {"cylinder", "A cylinder"},
    {"mesh", "A closed mesh of an OBJ file"},
    {"union", "All of these shapes together"},
    {"intersect", "What these shapes have in common"},
    {"subtract", "The first of these shapes without the others"},
    {"invert", "All outside of a shape"},
    {"rotate", "Turns it, about its middle unless origin says another point"},
    {"translate", "Moves it, after rotate [cm]"},
};

constexpr KeyMeaning kFabricKinds[] = {
    {"cloth_grid", "A rectangle of cloth"}, {"woven_yarns", "A weave of yarns"}, {"strand", "One yarn"},
    {"mesh", "Cloth of an OBJ file"},       {"points", "Yarns of an OBJ file"},
};

constexpr KeyMeaning kPinnedVertices[] = {
    {"corners", "All corners, or a list of some, like [\"x- z-\", \"x- z+\"]"},
    {"edge", "Those along a side, like x-"},
    {"nodes", "Those of these numbers, from 0"},
    {"shape", "Those inside of a shape"},
    {"box", "Those inside of a box"},
    {"ball", "Those inside of a ball"},
};

constexpr KeyMeaning kPieceKinds[] = {
    {"rotate", "Turns it"}, {"oscillate", "Swings it"}, {"keys", "Times and places that it passes, each [t, x, y, z]"}};

const DeclaredKey kLength = {
    .name = "", .kind = DeclaredKey::Kind::Numbers, .help = "", .quantity = sim::Quantity::Length, .count = 3, .words = {}, .below = {}};

SchemaJson pointSchema() { return keySchema(kLength, SchemaOf::Body); }

/// A map of keys that the reader is asked for; what other code reads behind some of them is told here.
SchemaJson schemaOfKeysRead(const std::vector<DeclaredKey>& keys, const std::vector<std::pair<std::string, SchemaJson>>& others)
{
    SchemaJson schema = mapSchema(keys, SchemaOf::Body);
    for (const auto& [key, value] : others) schema["properties"].at(key).update(value);
    return schema;
}

SchemaJson shapeKindSchema(const std::string& kind)
{
    if (kind == "invert") return definitionOf("shape");
    if (kind == "union" || kind == "intersect" || kind == "subtract") return listSchema(definitionOf("shape"), 1);
    return mapSchema(keysReadBy(fmt::format("{{{}: {{}}}}", kind), [](const Node& node) { sim::readShape(node, "", 1.0); }), SchemaOf::Body);
}

SchemaJson shapeSchema()
{
    SchemaJson properties = SchemaJson::object();
    for (const std::string& kind : sim::shapeKinds()) properties[kind] = shapeKindSchema(kind);
    properties["rotate"] = definitionOf("rotate");
    properties["translate"] = pointSchema();
    addMeanings(kShapeKinds, properties);
    SchemaJson schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    requireOneOf(sim::shapeKinds(), schema);
    return schema;
}

SchemaJson rotateSchema()
{
    return mapSchema(keysReadBy("{}", [](const Node& node) { sim::readRotation(node, "", sim::Vec3::Zero()); }), SchemaOf::Body);
}

SchemaJson sourceSchema()
{
    const auto keys = keysReadBy("liquid: {sources: [{}]}", [](const Node& node) { sim::readSources(node, {}, false); });
    sim::KeyList emission, fill;
    sim::Emission emissionValues;
    sim::FillSettings fillValues;
    sim::visitFields(emission, emissionValues);
    sim::visitFields(fill, fillValues);
    const SchemaJson fillMap = mapSchema(fill.keys, SchemaOf::Section);
    return schemaOfKeysRead(keys, {{"name", textSchema()},
                                   {"shape", definitionOf("shape")},
                                   {"velocity_field", {{"type", "array"}, {"items", textSchema()}, {"minItems", 3}, {"maxItems", 3}}},
                                   {"fill", {{"anyOf", {fillMap["properties"]["pattern"], fillMap}}}},
                                   {"emit", listSchema(mapSchema(emission.keys, SchemaOf::Body), 1)}});
}

SchemaJson openingSchema()
{
    sim::KeyList keys;
    sim::OpeningSettings values;
    sim::visitFields(keys, values);
    SchemaJson schema = mapSchema(keys.keys, SchemaOf::Body);
    schema["properties"]["name"] = textSchema();
    schema["properties"]["name"]["description"] = "What messages and the keys of variants call it";
    return schema;
}

SchemaJson obstacleSchema()
{
    const auto keys = keysReadBy("obstacles: [{}]", [](const Node& node) { sim::readObstacles(node, {}); });
    return schemaOfKeysRead(keys, {{"name", textSchema()}, {"shape", definitionOf("shape")}, {"motion", definitionOf("motion")}});
}

SchemaJson fabricKindSchema(const std::string& kind)
{
    const auto keys = keysReadBy("{}", [&](const Node& node) { sim::readFabricShape(node, "", kind); });
    SchemaJson schema = schemaOfKeysRead(keys, {{"material", textSchema()}});
    if (schema["properties"].contains("points")) schema["properties"]["points"].update(listSchema(pointSchema(), 2));
    return schema;
}

SchemaJson fabricSchema()
{
    const auto keys = keysReadBy("fabrics: [{}]", [](const Node& node) { sim::readFabrics(node, {}); });
    std::vector<std::pair<std::string, SchemaJson>> others = {
        {"name", textSchema()},
        {"material", textSchema()},
        {"pin", {{"anyOf", {definitionOf("pin"), listSchema(definitionOf("pin"))}}}},
        {"transform",
         {{"type", "object"}, {"properties", {{"rotate", definitionOf("rotate")}, {"translate", pointSchema()}}}, {"additionalProperties", false}}}};
    for (const std::string& kind : sim::fabricShapeKinds()) others.emplace_back(kind, fabricKindSchema(kind));
    SchemaJson schema = schemaOfKeysRead(keys, others);
    addMeanings(kFabricKinds, schema["properties"]);
    schema["properties"]["transform"]["properties"]["translate"]["description"] = "Moves it, after rotate [cm]";
    requireOneOf(sim::fabricShapeKinds(), schema);
    return schema;
}

SchemaJson pinSchema()
{
    const auto keys = keysReadBy("{}", [](const Node& node) { sim::readPins(node, "", {}, {}, 1.0); });
    const SchemaJson ends = {{"type", "string"}};
    SchemaJson shape = shapeSchema();
    SchemaJson schema = schemaOfKeysRead(keys, {{"corners", {{"anyOf", {{{"const", "all"}}, listSchema(ends)}}}},
                                                {"edge", ends},
                                                {"nodes", listSchema({{"type", "integer"}, {"minimum", 0}})},
                                                {"shape", definitionOf("shape")},
                                                {"box", shape["properties"]["box"]},
                                                {"ball", shape["properties"]["ball"]},
                                                {"motion", definitionOf("motion")}});
    addMeanings(kPinnedVertices, schema["properties"]);
    requireOneOf({"corners", "edge", "nodes", "shape", "box", "ball"}, schema);
    return schema;
}

/// Keys of any of the four kinds of pieces; those behind `rotate` and `oscillate` are asked for after them.
SchemaJson pieceSchema()
{
    const auto read = [](const Node& node) { sim::readMotion(node, ""); };
    std::vector<DeclaredKey> keys;
    const auto add = [](const std::vector<DeclaredKey>& more, std::vector<DeclaredKey>& all) {
        for (const DeclaredKey& key : more)
            if (std::ranges::find(all, key.name, &DeclaredKey::name) == all.end()) all.push_back(key);
    };
    for (const char* kind : {"{translate: [0, 1, 0]}", "{rotate: {}}", "{oscillate: {}}", "{keys: []}"}) add(keysReadBy(kind, read), keys);
    std::vector<DeclaredKey> swing = keysReadBy("{t: [0, 1], oscillate: {}}", read);
    const std::vector<DeclaredKey> turning = keysReadBy("{t: [0, 1], oscillate: {axis: [0, 1, 0]}}", read);
    for (DeclaredKey& key : swing)  // a length, or about an axis an angle
        if (key.name == "amplitude") key.quantity = sim::Quantity::None, key.range = sim::Range::any();
    add(turning, swing);
    SchemaJson oscillate = mapSchema(swing, SchemaOf::Body);
    oscillate["properties"]["amplitude"] = {{"anyOf", {{{"type", "number"}}, {{"type", "string"}}}}, {"description", "[cm], or about an axis [deg]"}};
    SchemaJson row = pointSchema();
    row["minItems"] = row["maxItems"] = 4;
    SchemaJson schema = schemaOfKeysRead(
        keys,
        {{"rotate", mapSchema(keysReadBy("{t: [0, 1], rotate: {}}", read), SchemaOf::Body)}, {"oscillate", oscillate}, {"keys", listSchema(row, 2)}});
    addMeanings(kPieceKinds, schema["properties"]);
    return schema;
}

}  // namespace

SchemaJson bodyDefinitions()
{
    const SchemaJson piece = definitionOf("motion_piece");
    SchemaJson definitions = {{"shape", shapeSchema()},     {"rotate", rotateSchema()},      {"source", sourceSchema()},
                              {"opening", openingSchema()}, {"obstacle", obstacleSchema()},  {"fabric", fabricSchema()},
                              {"pin", pinSchema()},         {"motion_piece", pieceSchema()}, {"motion", {{"anyOf", {piece, listSchema(piece, 1)}}}}};
    requireOneOf({"translate", "rotate", "oscillate", "keys"}, definitions["motion_piece"]);
    SchemaJson named = definitions["motion_piece"];
    for (const char* target : {"obstacle", "group", "pin"}) {
        named["properties"][target] = textSchema();
        named["properties"][target]["description"] = "Name of what moves";
    }
    definitions["named_motion_piece"] = named;
    return definitions;
}

}  // namespace app
