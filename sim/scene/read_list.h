#pragma once

#include "sim/scene/node.h"

#include <fmt/format.h>

#include <string>
#include <vector>

// Lists of named things: sources, obstacles, fabrics.

namespace sim {

/// The list behind a key, or nullptr; anything but a list is refused.
const Node* listAt(const Node* map, const char* key, const std::string& path, const char* example);

/// The element's name, or its number where it has none: as overrides address it.
std::string nameIn(const Node& element, std::size_t index, const std::string& path);

/// Refuses what overrides could not address.
void requireName(const std::string& text, const SourceLocation& location, const std::string& path);

template <class Settings>
void requireUnique(const std::vector<Settings>& all, const std::string& path)
{
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (all[i].name == all[k].name) fail(all[i].where, fmt::format("{}: two are named {}; rename one", path, inQuotes(all[i].name)));
        }
    }
}

}  // namespace sim
