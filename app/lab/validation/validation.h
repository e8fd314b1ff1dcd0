#pragma once

#include "app/lab/checks/check.h"
#include "app/readings/measures.h"
#include "app/scene/loaded_scene.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// The section `validate` of a scene: a run whose outcome is known.
struct Validation {
    std::string about, source;
    double every = 0.0;              ///< time between readings [s]
    std::vector<std::string> quick;  ///< overrides that make it short
    std::vector<Check> checks;
    std::shared_ptr<Measures> measures;  ///< what the formulas look at
};

/// Nothing where a scene has no such section. Throws InputError.
std::optional<Validation> readValidation(const LoadedScene& setup);

}  // namespace app
