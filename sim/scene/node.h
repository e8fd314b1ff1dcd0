#pragma once

#include "sim/scene/source_location.h"

#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// A value of a scene file: nothing, a word or number as text, a list, or a map; and where it stands.
/// A plain value type: merging and overriding copy what they need.
struct Node {
    enum class Kind { Null, Scalar, List, Map };

    Kind kind = Kind::Null;
    SourceLocation location;        ///< in a map: the line of the key
    std::string text;               ///< text of a scalar
    std::vector<std::string> keys;  ///< keys of a map, in the order of the file; as many as items
    std::vector<Node> items;        ///< items of a list or a map

    bool isNull() const { return kind == Kind::Null; }
    bool isScalar() const { return kind == Kind::Scalar; }
    bool isList() const { return kind == Kind::List; }
    bool isMap() const { return kind == Kind::Map; }

    static Node scalar(std::string text, const SourceLocation& location);
    static Node map(const SourceLocation& location);

    /// The value behind a key of a map; nullptr if there is none (or this is no map).
    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
    /// The value behind a key of a map, made (empty) if missing.
    Node& at(const std::string& key, const SourceLocation& keyLocation);
    void erase(std::string_view key);

    /// The node on one line, as YAML that reads back to the same.
    std::string flow() const;
    /// What it is, for "needs a number, not …": `"abc"`, "a list", "a map", "nothing".
    std::string called() const;
};

/// Reads one YAML document. Anchors and aliases are copied out and merge keys (<<) followed; depth, size and number of values are bounded.
/// Throws InputError at the line of what is wrong: syntax, bytes that are no text, tabs as indentation, a key given
/// twice.
Node parseYaml(const std::string& text, const std::shared_ptr<const TextSource>& source);

}  // namespace sim
