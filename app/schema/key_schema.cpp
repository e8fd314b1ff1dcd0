#include "app/schema/key_schema.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace app {

namespace {

using sim::DeclaredKey;
using Kind = DeclaredKey::Kind;

constexpr const char* kDigits = R"([-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?)";

/// Bounds hold for bare numbers in either system of units: where the unit is another in SI only 0 is the same.
void addBounds(const DeclaredKey& key, SchemaJson& number)
{
    const bool isSameInSi = std::strcmp(sim::unitOf(key.quantity, false), sim::unitOf(key.quantity, true)) == 0;
    const auto add = [&](double bound, bool isOpen, const char* open, const char* closed) {
        if (std::isfinite(bound) && (isSameInSi || bound == 0.0)) number[isOpen ? open : closed] = bound;
    };
    add(key.range.low, key.range.isLowOpen, "exclusiveMinimum", "minimum");
    add(key.range.high, key.range.isHighOpen, "exclusiveMaximum", "maximum");
}

/// A bare number, or one with a unit behind it, which is a text to JSON.
SchemaJson numberSchema(const DeclaredKey& key)
{
    SchemaJson bare = {{"type", "number"}};
    addBounds(key, bare);
    const bool hasUnit = *sim::unitOf(key.quantity) != '\0';
    const SchemaJson text = {{"type", "string"}, {"pattern", fmt::format("^ *{}{} *$", kDigits, hasUnit ? " *([^0-9 .+-][^.]*)?" : "")}};
    return {{"anyOf", {bare, text}}};
}

SchemaJson integerSchema(const DeclaredKey& key)
{
    SchemaJson schema = {{"type", "integer"}, {"minimum", static_cast<std::int64_t>(key.range.low)}};
    if (std::isfinite(key.range.high)) schema["maximum"] = static_cast<std::int64_t>(key.range.high);
    return schema;
}

/// Words as YAML 1.2 reads them: true and false are no texts.
SchemaJson wordSchema(const std::vector<std::string>& words)
{
    SchemaJson all = SchemaJson::array();
    for (const std::string& word : words)
        if (word == "true" || word == "false") all.push_back(word == "true");
        else all.push_back(word);
    return {{"enum", all}};
}

SchemaJson listOf(const SchemaJson& items, std::size_t count)
{
    return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

SchemaJson anyOf(const SchemaJson& a, const SchemaJson& b) { return {{"anyOf", {a, b}}}; }

SchemaJson bareKeySchema(const DeclaredKey& key, SchemaOf of)
{
    switch (key.kind) {
        case Kind::Number: return key.words.empty() ? numberSchema(key) : anyOf(numberSchema(key), wordSchema(key.words));
        case Kind::Numbers: return listOf(numberSchema(key), key.count);
        case Kind::NumberOrPair: return anyOf(numberSchema(key), listOf(numberSchema(key), key.count));
        case Kind::Integer: return integerSchema(key);
        case Kind::Integers: return listOf(integerSchema(key), key.count);
        case Kind::Flag: return {{"type", "boolean"}};
        case Kind::Text: return textSchema();
        case Kind::Texts: return listSchema(textSchema());
        case Kind::Word: return wordSchema(key.words);
        case Kind::Words: return listSchema(wordSchema(key.words));
        case Kind::Map: return mapSchema(key.below, of);
        case Kind::PerPhase: return anyOf(keySchema(key.below.front(), of), mapSchema(key.below, of));
        case Kind::Formula: return formulaSchema();
        case Kind::Other: break;
    }
    return SchemaJson::object();
}

/// "Edge of a grid cell [cm], above 0": help, unit and range on one line.
std::string descriptionOf(const DeclaredKey& key)
{
    const std::string unit = sim::unitOf(key.quantity), range = key.kind == Kind::Integer || key.kind == Kind::Integers ? "" : key.range.text("");
    std::string text(key.kind == Kind::PerPhase && key.help.empty() ? key.below.front().help : key.help);
    if (!unit.empty()) text += fmt::format("{}[{}]", text.empty() ? "" : " ", unit);
    if (!range.empty()) text += fmt::format("{}{}", text.empty() ? "" : ", ", range);
    return text;
}

/// A number as a scene in cgs says it.
SchemaJson valueInFile(double value, sim::Quantity quantity) { return SchemaJson::parse(sim::formatNumber(value, quantity)); }

/// What holds where the key is left out; null for what has no such value.
SchemaJson valueOf(const DeclaredKey& key)
{
    const auto list = [&](std::size_t count) {
        SchemaJson all = SchemaJson::array();
        for (std::size_t i = 0; i < count; ++i) all.push_back(valueInFile(key.values[i], key.quantity));
        return all;
    };
    switch (key.kind) {
        case Kind::Number:
            if (!key.word.empty()) return key.word;
            return std::isfinite(key.values[0]) ? valueInFile(key.values[0], key.quantity) : SchemaJson();
        case Kind::Numbers: return list(key.count);
        case Kind::Integer: return static_cast<std::int64_t>(key.values[0]);
        case Kind::Integers: return {static_cast<std::int64_t>(key.values[0]), static_cast<std::int64_t>(key.values[1])};
        case Kind::Flag: return key.values[0] != 0.0;
        case Kind::Word: return key.word.empty() ? SchemaJson() : wordSchema({key.word})["enum"][0];
        default: return nullptr;
    }
}

}  // namespace

SchemaJson keySchema(const DeclaredKey& key, SchemaOf of)
{
    SchemaJson schema = bareKeySchema(key, of);
    if (const std::string text = descriptionOf(key); !text.empty()) schema["description"] = text;
    if (const SchemaJson value = valueOf(key); of == SchemaOf::Section && !key.isNeeded && !value.is_null()) schema["default"] = value;
    return schema;
}

SchemaJson mapSchema(std::span<const DeclaredKey> keys, SchemaOf of)
{
    SchemaJson properties = SchemaJson::object(), required = SchemaJson::array();
    for (const DeclaredKey& key : keys) {
        properties[key.name] = keySchema(key, of);
        if (key.isNeeded && of == SchemaOf::Body) required.push_back(key.name);
    }
    SchemaJson schema = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
    if (!required.empty()) schema["required"] = required;
    return schema;
}

SchemaJson textSchema() { return {{"type", {"string", "number", "boolean"}}}; }

SchemaJson formulaSchema()
{
    SchemaJson schema = textSchema();
    schema["format"] = "formula";
    return schema;
}

SchemaJson namedSchema(const SchemaJson& value) { return {{"type", "object"}, {"additionalProperties", value}}; }

SchemaJson listSchema(const SchemaJson& items, std::size_t atLeast)
{
    SchemaJson schema = {{"type", "array"}, {"items", items}};
    if (atLeast > 0) schema["minItems"] = atLeast;
    return schema;
}

void requireOneOf(const std::vector<std::string>& keys, SchemaJson& map)
{
    SchemaJson all = SchemaJson::array();
    for (const std::string& key : keys) all.push_back({{"required", SchemaJson::array({key})}});
    map["oneOf"] = all;
}

void addMeanings(std::span<const KeyMeaning> meanings, SchemaJson& properties)
{
    for (const KeyMeaning& m : meanings) properties.at(m.key)["description"] = m.meaning;
}

SchemaJson definitionOf(const char* name) { return {{"$ref", fmt::format("#/definitions/{}", name)}}; }

}  // namespace app
