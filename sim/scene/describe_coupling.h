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

inline std::span<const Choice<DragFraction>> choicesOf(DragFraction)
{
    static constexpr Choice<DragFraction> kAll[] = {{"fabric", DragFraction::Fabric}, {"cell", DragFraction::Cell}};
    return kAll;
}

inline std::span<const Choice<CaptureLaw>> choicesOf(CaptureLaw)
{
    static constexpr Choice<CaptureLaw> kAll[] = {{"fabric", CaptureLaw::Fabric}, {"published", CaptureLaw::Published}};
    return kAll;
}

template <class V>
void visitFields(V& v, CaptureSettings& c)
{
    v.choice("law", c.law, "By the fabric's pores, or by the liquid in the cells around as published");
    v.number("rate", c.rate, Quantity::Frequency, Range::atLeast(0.0), "Part of its pores that fabric in liquid fills per time; 0 = it stays dry");
    v.number("published_rate_factor", c.publishedRateFactor, Quantity::None, Range::atLeast(0.0),
             "Law published: factor on its rate; 3 as published, 1 physical, 0 = fabric stays dry");
    const bool isPublished = c.law == CaptureLaw::Published;
    v.require(!isPublished || c.rate == 0.0 || c.rate == CaptureSettings().rate, "rate",
              "law published has a rate of its own, times published_rate_factor; leave rate out, or 0 for fabric that stays dry");
    v.require(isPublished || c.publishedRateFactor == CaptureSettings().publishedRateFactor, "published_rate_factor",
              "is of law published only; law fabric goes by rate");
}

template <class V>
void visitFields(V& v, WickingSettings& w)
{
    v.number("rate_scale", w.rateScale, Quantity::None, Range::atLeast(0.0), "Factor on the flow of liquid inside fabric; 0 = it stays");
    v.number("suction_exponent", w.suctionExponent, Quantity::None, Range::between(0.1, 100.0),
             "a of the suction P_c (1 - S^a) of pores that are full to S; 1 = linear, 10 and more: fronts are sharp");
    v.number("permeability_exponent", w.permeabilityExponent, Quantity::None, Range::between(1.0, 100.0),
             "b of the permeability S^b of such pores, relative to that of full ones");
    v.flag("pressure", w.pressure, "The pressure of the liquid around drives that flow too");
}

template <class V>
void visitFields(V& v, CohesionSettings& c)
{
    v.number("strength", c.strength, Quantity::None, Range::atLeast(0.0),
             "Of liquid bridges: 1 is the capillary force along the threads that touch; 2e-3 as published, 0 = none");
    v.flag("fabric", c.fabric, "They hold fabric on fabric");
    v.flag("obstacle", c.obstacle, "They hold fabric on solids");
}

template <class V>
void visitFields(V& v, CouplingSettings& c)
{
    v.choice("drag", c.drag, "What liquid feels that flows through fabric; off: it still moves inside of it as with nonlinear");
    v.choice("drag_fraction", c.dragFraction, "Whose fraction of fibres drag goes by: the fabric's own, or the cell's mean as published");
    v.number("drag_exponent", c.dragExponent, Quantity::None, Range::between(1.0, 2.0), "Of the speed in nonlinear drag; 1 is Forchheimer's law");
    v.flag("pressure_on_fabric", c.pressureOnFabric, "The liquid's pressure pushes the fabric: buoyancy");
    v.flag("capillary", c.capillary, "Suction of empty pores draws the liquid around");
    v.flag("capillary_reaction", c.capillaryReaction, "That liquid draws the fabric; the published model has no reaction");
    v.section("capture", c.capture, "Fabric takes up liquid");
    v.section("wicking", c.wicking, "Liquid moves in fabric");
    v.flag("drip", c.drip, "Fabric lets go of liquid that its pores cannot hold");
    v.onlySupports("drag_uses_new_velocity", "true", {"false"}, "Drag by the fabric's velocity at the end of the step");
    v.onlySupports("air_drag", "false", {"true"}, "Air drags fabric");
    v.onlySupports("varying_fraction", "false", {"true"}, "Fabric that is stretched has wider pores");
    v.onlySupports("pore_pressure_on_fabric", "false", {"true"}, "Suction in its pores moves fabric");
    v.section("cohesion", c.cohesion, "Wet fabric sticks, fabric.solver vertex only");
}

}  // namespace sim
