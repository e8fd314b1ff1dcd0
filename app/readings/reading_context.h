#pragma once

#include "app/readings/measures.h"
#include "sim/scene/node.h"
#include "sim/scene/section_reader.h"

#include <string>

// What the sections of a scene that ask for readings (validate, precision, output.probes) have in common.

namespace app {

/// What formulas of such a section may use.
struct ReadingContext {
    std::string path;           ///< path of the section, for messages
    sim::FormulaNames reading;  ///< names of what is read: measures and the time
    sim::FormulaNames known;    ///< names of what is expected: the time
    sim::FormulaNames constant;
};

/// Keys of such a section that readContext reads.
template <class Visitor>
void describeContext(Visitor& v)
{
    v.other("let", "Names for formulas");
    v.other("flow", "Velocity, three formulas of x, y, z and t, of which flow_error and flow_part tell [cm/s]");
    v.other("control_surfaces", "Planes and discs through which flux(\"name\") is read, discs on which pressure_on(\"name\") is");
}

/// Names of the scene (g, density, viscosity, surface_tension, dx, duration), of the section's `let`, and of the
/// measures, which learn its `flow`. Throws InputError.
ReadingContext readContext(const sim::SectionReader& section, const sim::Scene& scene, Measures& measures);

/// The key `every` of the section: time between readings [s]. Throws InputError.
double readInterval(sim::SectionReader& section, const ReadingContext& context);

/// Throws InputError naming what is wrong with the formula, or with its value.
sim::Formula readFormula(const sim::Node& node, const std::string& path, const sim::FormulaNames& names);
double readConstant(const sim::Node& node, const std::string& path, const ReadingContext& context);

}  // namespace app
