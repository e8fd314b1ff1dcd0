#pragma once

#include "app/lab/checks/check.h"
#include "app/readings/measures.h"
#include "app/scene/loaded_scene.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// One of the ways to run a case: its name and what it changes.
struct PrecisionChoice {
    std::string name;
    std::vector<std::string> sets = {};  ///< "dotted.key=value"
    bool isQuick = true;
    double cells = 0.0;  ///< cells that liquid as fast as Precision::speed crosses per step, which gives the step; 0: no matter
};

/// What is chosen for one run, by name.
struct PrecisionNames {
    std::string method, integrator, step, resolution;
    auto operator<=>(const PrecisionNames&) const = default;
};

/// The section `precision` of a scene: what it is run with, and what its outcome is held against.
struct Precision {
    std::string about;
    double every = 0.0;                  ///< time between readings [s]
    std::vector<Check> errors;           ///< the error of a run is the root mean square of these
    std::optional<sim::Formula> energy;  ///< energy of which the table tells what is left
    double decay = 0.0;                  ///< the energy decays at this times the kinematic viscosity [1/cm²]; 0: not known
    double speed = 0.0;                  ///< [cm/s]
    std::vector<PrecisionChoice> methods, integrators, steps, resolutions;  ///< every combination is run
    PrecisionNames published;                                               ///< the scheme to compare with, of any resolution; empty: none
    std::vector<std::string> converged;                                     ///< changes that make the run which tells what is not known otherwise
    bool isHeadline = false;                                                ///< drawn beside the other such cases
    std::string question;                                                   ///< as text: all that the error of a run depends on beside the run
    std::shared_ptr<Measures> measures;                                     ///< what the formulas look at

    /// Is there an error that only a converged run tells?
    bool needsConverged() const;
};

/// Nothing where a scene has no such section. Throws InputError.
std::optional<Precision> readPrecision(const LoadedScene& setup);

/// How far a finding is from what is known: relative to that, or absolute where that is nothing.
double errorOf(const Check& check, std::span<const Sample> readings);

}  // namespace app
