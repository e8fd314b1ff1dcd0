#pragma once

#include "sim/scene/node.h"

#include <string>
#include <vector>

namespace sim {

/// One dotted override: `transfer.method=apic`, in a variant or behind --set.
struct Override {
    std::string path;  ///< keys with dots between; an element of a list by its name or its number from 0
    Node value;        ///< value, with the location where messages about it point

    /// The override as it would stand behind --set.
    std::string text() const { return path + "=" + value.flow(); }
};

/// Throws InputError unless it is words with dots between, without a = sign.
void checkPath(const std::string& path, const SourceLocation& location);

/// Reads "key.key=value"; the value is YAML on one line. Throws InputError naming the override.
/// @param notes  of keys that were called otherwise before (old_keys.h), if asked for
Override parseOverride(const std::string& text, bool isSi, std::vector<std::string>* notes = nullptr);

/// Lays `over` on top of `base`: maps are merged key by key, anything else is replaced.
void mergeOver(Node& base, const Node& over);

/// Puts the value at its path, merging maps and making missing sections. Throws InputError where the path leads through
/// something that has no keys, or to an element that a list does not have.
void apply(const Override& change, Node& root);

/// Writes out short forms, so that they merge like the long ones: `transfer: apic` is {method: apic},
/// `fill: lattice` of a source is {pattern: lattice}.
void expandShortForms(Node& root);

/// The keys of a map as overrides, but those in `except`: dotted keys as they are, nested maps as one each.
/// Throws InputError at a key that is no path.
std::vector<Override> overridesOf(const Node& map, const std::vector<std::string>& except);

}  // namespace sim
