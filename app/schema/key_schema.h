#pragma once

#include "sim/scene/key_list.h"

#include <nlohmann/json.hpp>

#include <span>

// JSON schema of what declarations say, with the words of JSON schema, draft 7.

namespace app {

using SchemaJson = nlohmann::ordered_json;

/// Whose keys they are.
enum class SchemaOf {
    Section,  ///< section of a scene: what is left out has a value, which is told, or stands in a file that is included
    Body,     ///< in a list, which no other file adds to: what is needed must be there
};

/// What a key may be.
SchemaJson keySchema(const sim::DeclaredKey& key, SchemaOf of);

/// A map with these keys and no others.
SchemaJson mapSchema(std::span<const sim::DeclaredKey> keys, SchemaOf of);

/// A map from words that the user chooses.
SchemaJson namedSchema(const SchemaJson& value);

/// Any word, as a name may be: to YAML some are numbers.
SchemaJson textSchema();
/// A text that is marked as a formula.
SchemaJson formulaSchema();

SchemaJson listSchema(const SchemaJson& items, std::size_t atLeast = 0);

/// Exactly one of these keys of a map must be there.
void requireOneOf(const std::vector<std::string>& keys, SchemaJson& map);

/// A definition of the schema: "#/definitions/shape".
SchemaJson definitionOf(const char* name);

/// What keys mean whose own code does not say it.
struct KeyMeaning {
    const char *key, *meaning;
};
void addMeanings(std::span<const KeyMeaning> meanings, SchemaJson& properties);

}  // namespace app
