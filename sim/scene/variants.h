#pragma once

#include "sim/scene/overrides.h"

#include <string>
#include <vector>

namespace sim {

/// One of the runs that `compare.variants` asks for.
struct SceneVariant {
    std::string name;                 ///< [a-z0-9_]+, unique; its folder and what --variant takes
    std::string label;                ///< as pictures and tables show it
    std::vector<Override> overrides;  ///< in the order of the file
};

/// The variants of a merged scene tree, in order: a list of {label, name, dotted overrides}, or a map of dotted keys to
/// lists of values, whose product they are. Empty if the scene has none. Throws InputError.
std::vector<SceneVariant> readVariants(const Node& root);

/// The variants of such a list or map itself; `path` names it in messages.
std::vector<SceneVariant> listedVariants(const Node& variants, const std::string& path);

/// The variant of that name; throws InputError naming those there are.
const SceneVariant& findVariant(const std::vector<SceneVariant>& variants, const std::string& name, const std::string& file);

/// "PolyPIC 8" → "polypic_8": lower case, `_` for everything but letters and digits.
std::string asName(const std::string& label);

}  // namespace sim
