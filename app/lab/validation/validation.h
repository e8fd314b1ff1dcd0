#pragma once

#include "app/lab/checks/check.h"
#include "app/readings/measures.h"
#include "app/scene/loaded_scene.h"
#include "sim/scene/choice.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace app {

/// Where the outcome of a run is known from.
enum class KnownFrom {
    Theory,    ///< a formula, or another solution of the same equations
    Measured,  ///< an experiment: of the model, too, it is told how near to nature it is
};

/// Kinds as scene files write them.
inline std::span<const sim::Choice<KnownFrom>> choicesOf(KnownFrom)
{
    static constexpr sim::Choice<KnownFrom> kAll[] = {{"theory", KnownFrom::Theory}, {"measured", KnownFrom::Measured}};
    return kAll;
}

/// The section `validate` of a scene: a run whose outcome is known.
struct Validation {
    std::string about, source;
    KnownFrom kind = KnownFrom::Theory;
    double every = 0.0;              ///< time between readings [s]
    std::vector<std::string> quick;  ///< overrides that make it short
    std::vector<Check> checks;
    std::shared_ptr<Measures> measures;  ///< what the formulas look at
};

/// Nothing where a scene has no such section. Throws InputError.
std::optional<Validation> readValidation(const LoadedScene& setup);

}  // namespace app
