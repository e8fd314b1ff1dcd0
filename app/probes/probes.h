#pragma once

#include "app/readings/measures.h"
#include "app/scene/loaded_scene.h"
#include "sim/core/types.h"
#include "sim/scene/formula.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// A number that is read as a scene runs, or one at each of some points.
struct Probe {
    std::string name, unit;
    sim::Formula read;              ///< formula of the time, and of x, y, z where there are points; knows the names of measures.h
    std::vector<sim::Vec3> points;  ///< along a line [cm]; empty: it is read once
};

/// The section `output.probes` of a scene.
struct Probes {
    double every = 0.0;  ///< time between readings [s]; that between frames unless the section says otherwise
    std::vector<Probe> all;
    std::shared_ptr<Measures> measures;  ///< what the formulas look at

    /// Columns of the table of readings: the time, then each reading with its unit, "head [cm]", "wetness at 2.5 cm [-]".
    std::vector<std::string> columns() const;
};

/// Nothing where a scene has no such section. Throws InputError.
std::optional<Probes> readProbes(const LoadedScene& setup);

}  // namespace app
