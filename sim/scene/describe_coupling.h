#pragma once

#include "sim/scene/choice.h"
#include "sim/scene/range.h"
#include "sim/scene/units.h"
#include "sim/settings.h"

#include <span>

// The keys of `coupling`, like describe.h.

namespace sim {

inline std::span<const Choice<DragLaw>> choicesOf(DragLaw)
{
    static constexpr Choice<DragLaw> kAll[] = {{"nonlinear", DragLaw::Nonlinear}, {"linear", DragLaw::Linear}, {"off", DragLaw::Off}};
    return kAll;
}

template <class V>
void describe(V& v, CouplingSettings& c)
{
    v.choice("drag", c.drag, "What liquid feels that flows through fabric");
    v.number("drag_exponent", c.dragExponent, Quantity::None, Range::between(1.0, 2.0), "Of the speed in nonlinear drag; 1 is Forchheimer's law");
    v.flag("pressure_on_fabric", c.pressureOnFabric, "The liquid's pressure pushes the fabric: buoyancy");
    v.onlyRuns("drag_uses_new_velocity", "true", {"false"}, "Drag by the fabric's velocity at the end of the step");
    v.onlyRuns("air_drag", "false", {"true"}, "Air drags fabric");
    v.onlyRuns("varying_fraction", "false", {"true"}, "Fabric that is stretched has wider pores");
    for (const char* key : {"capillary", "capillary_reaction", "pore_pressure_on_fabric", "capture", "wicking", "drip", "cohesion"})
        v.later(key, "this version has drag and pressure between liquid and fabric, which takes up no liquid; remove the key");
}

}  // namespace sim
