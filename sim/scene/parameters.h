#pragma once

#include "sim/scene/range.h"
#include "sim/scene/scene.h"

#include <string>
#include <vector>

namespace sim {

/// One setting of a scene as a panel or a list of changes shows it, from the declarations in describe.h.
struct Parameter {
    enum class Kind { Number, Numbers, Integer, Flag, Word };

    std::string path;  ///< "time.dt"
    Kind kind = Kind::Number;
    std::string value;               ///< as a scene in cgs says it; empty where it is left out
    std::string unit;                ///< unit of bare numbers; "" for plain ones
    Range range;                     ///< range of numbers, in that unit
    std::vector<std::string> words;  ///< words that it may be, Word only
    std::string help;                ///< one line
    bool isFixed = false;            ///< holds for a whole run: a change needs a new one
};

/// What `--set` takes to give the parameter a value, with its unit where the value is of bare numbers: it means the
/// same in scenes of every system of units.
std::string overrideText(const Parameter& parameter, const std::string& value);

/// Every plain setting, in the order of the declarations, then those of the materials.
std::vector<Parameter> parametersOf(const Settings& settings, const std::vector<NamedMaterial>& materials);

}  // namespace sim
