#pragma once

#include "sim/scene/choice.h"
#include "sim/scene/fabric_presets.h"
#include "sim/scene/range.h"
#include "sim/scene/scene.h"
#include "sim/scene/units.h"

#include <span>

// The keys of the sections of fabric but the pieces themselves (read_fabrics.h), like describe.h.

namespace sim {

inline std::span<const Choice<FabricSolver>> choicesOf(FabricSolver)
{
    static constexpr Choice<FabricSolver> kAll[] = {{"vertex", FabricSolver::Vertex}, {"grid", FabricSolver::Grid}, {"off", FabricSolver::Off}};
    return kAll;
}

inline std::span<const Choice<MembraneModel>> choicesOf(MembraneModel)
{
    static constexpr Choice<MembraneModel> kAll[] = {{"stvk", MembraneModel::StVk}, {"neo_hookean", MembraneModel::NeoHookean}};
    return kAll;
}

inline std::span<const Choice<BendingModel>> choicesOf(BendingModel)
{
    static constexpr Choice<BendingModel> kAll[] = {{"shape_operator", BendingModel::ShapeOperator}, {"hinge", BendingModel::Hinge}};
    return kAll;
}

inline std::span<const Choice<HingeMeasure>> choicesOf(HingeMeasure)
{
    static constexpr Choice<HingeMeasure> kAll[] = {{"angle", HingeMeasure::Angle}, {"sin", HingeMeasure::Sin}, {"tan", HingeMeasure::Tan}};
    return kAll;
}

inline std::span<const Choice<FabricTimeIntegrator>> choicesOf(FabricTimeIntegrator)
{
    static constexpr Choice<FabricTimeIntegrator> kAll[] = {{"second_order", FabricTimeIntegrator::SecondOrder},
                                                            {"backward_euler", FabricTimeIntegrator::BackwardEuler}};
    return kAll;
}

inline std::span<const Choice<TorsionModel>> choicesOf(TorsionModel)
{
    static constexpr Choice<TorsionModel> kAll[] = {{"ellipse", TorsionModel::Ellipse}, {"polar", TorsionModel::Polar}};
    return kAll;
}

template <class V>
void visitFields(V& v, FabricSettings& f)
{
    v.fixed([&](auto& w) { w.choice("solver", f.solver, "off: pins follow their motions, all else stays where it is"); });
    v.choice("integrator", f.integrator,
             "second_order keeps the energy of what swings, backward_euler takes it; solver vertex only: grid is of first order");
    v.choice("membrane", f.membrane, "How cloth resists stretching");
    v.choice("bending", f.bending, "How cloth resists bending");
    v.group("hinge", "Read by bending: hinge only", [&](auto& w) {
        w.number("constant", f.hingeConstant, Quantity::None, Range::above(0.0), "Factor on the stiffness; the published code has 3");
        w.choice("measure", f.hingeMeasure, "What is measured of the angle between two triangles");
    });
    v.choice("torsion", f.torsion, "Stiffness of a yarn's section against twist; polar as published");
    v.flag("twist", f.twist, "Yarns resist twisting");
    v.integer("newton", f.newton, 1, 100, "Newton iterations per step, solver vertex only");
    v.numberOr("tolerance", f.tolerance, 0.0, Quantity::None, Range::aboveTo(0.0, 1.0e3),
               "Left out: 1e-2 of the residual with solver vertex, 5e-3 of gravity times the step with grid");
    v.fixed([&](auto& w) { w.flag("contact", f.contact, "Fabric touches itself and obstacles"); });
    v.integer("max_halvings", f.maxHalvings, 0, 30,
              "Of a step that could not be taken, solver vertex only; where pins or solids drive the fabric, two at least");
}

class SectionReader;

/// Whatever two are given, fibre diameter and volume fraction follow. Throws InputError where not two are given.
void resolvePorous(const SectionReader& section, double poreRadius, double threads, double thickness, PorousSettings& porous);

/// The two of `porous` that everything follows from, and the other ways to say them.
template <class V>
void visitFields(V& v, PorousSettings& p)
{
    v.fixed([&](auto& w) {
        w.number("fibre_diameter", p.fibreDiameter, Quantity::Length, Range::above(0.0), "Thickness of a fibre");
        w.number("volume_fraction", p.volumeFraction, Quantity::None, Range::aboveTo(0.0, 1.0),
                 "Fibres per volume of fabric, for materials that do not say their own");
    });
    v.when(false, [&](auto& w) {
        double poreRadius = 0.0, threads = 0.0, thickness = 0.0;
        w.number("pore_radius", poreRadius, Quantity::Length, Range::above(0.0), "Radius of a pore, in the place of one of the other two");
        w.number("thread_count", threads, Quantity::None, Range::above(0.0), "Threads per cm^2 in every system of units");
        w.number("thickness", thickness, Quantity::Length, Range::above(0.0), "Of the cloth, with thread_count");
        w.whenReading([&](auto& reader) { resolvePorous(reader, poreRadius, threads, thickness, p); });
    });
}

template <class V>
void visitFields(V& v, FabricMaterial& m)
{
    v.other("preset", "Sets the rest to what a common fabric has; what stands beside it holds, young in the place of its stiffnesses");
    v.whenReading([&](auto& reader) {
        readFabricPreset(reader, m);
        if (m.young == 0.0) reader.required("young", "Young's modulus of the fibres, like young: 6.6e+7 (dyn/cm^2) or young: 6.6 MPa");
    });
    v.numberOr("young", m.young, 0.0, Quantity::Pressure, Range::above(0.0), "Young's modulus of the fibres; left out: that of preset");
    v.number("poisson", m.poisson, Quantity::None, Range::inside(-1.0, 0.5), "Poisson's ratio");
    v.fixed([&](auto& w) { w.number("density", m.density, Quantity::Density, Range::above(0.0), "Of the fibres"); });
    v.number("damping_viscosity", m.dampingViscosity, Quantity::Viscosity, Range::atLeast(0.0), "Viscosity of the fibres, which damps; 0 = none");
    v.flag("damp_bending", m.dampBending, "It acts on bending and twisting");
    v.flag("damp_stretching", m.dampStretching, "It acts on stretching");
    v.number("stretch_factor", m.stretchFactor, Quantity::None, Range::above(0.0), "On the stretching stiffness of yarns");
    v.number("contact_stiffness", m.contactStiffness, Quantity::None, Range::above(0.0), "Of contact relative to young, fabric.solver grid only");
    v.number("pin_stiffness", m.pinStiffness, Quantity::None, Range::above(0.0), "Of pins relative to young, fabric.solver grid only");
    v.number("friction_angle", m.frictionAngle, Quantity::Angle, Range::between(0.0, 89.0),
             "Slope on which it starts to slide; its tangent is Coulomb's coefficient");
    v.fixed([&](auto& w) {
        w.number("volume_fraction", m.volumeFraction, Quantity::None, Range::aboveTo(0.0, 1.0),
                 "Fibres per volume of fabric; left out: that of porous, 1 without it");
        w.number("section_rotation", m.sectionRotation, Quantity::Angle, Range::between(-360.0, 360.0), "Of an elliptic section about the yarn");
        w.numberOr("thickness", m.thickness, 0.0, Quantity::Length, Range::above(0.0), "Of cloth that says no radius");
    });
    v.numberOrPair("stretch_stiffness", m.stretchStiffness, Quantity::Stiffness, Range::atLeast(0.0),
                   "Of cloth, force per width and strain along warp and weft; 0 = by young");
    v.number("shear_stiffness", m.shearStiffness, Quantity::Stiffness, Range::atLeast(0.0),
             "Of cloth with stretch_stiffness, force per width and angle; 0 = as if it were alike in all directions");
    v.numberOrPair("bending_stiffness", m.bendingStiffness, Quantity::BendingStiffness, Range::atLeast(0.0),
                   "Of cloth, moment per width and curvature, warp and weft bent; 0 = by young");
    const auto areBoth = [](const std::array<double, 2>& of) { return (of[0] > 0.0) == (of[1] > 0.0); };
    v.require(areBoth(m.stretchStiffness), "stretch_stiffness", "one of warp and weft is 0; give both, or 0 for both");
    v.require(areBoth(m.bendingStiffness), "bending_stiffness", "one of warp and weft is 0; give both, or 0 for both");
    v.require(m.shearStiffness == 0.0 || m.stretchStiffness[0] > 0.0, "shear_stiffness", "needs stretch_stiffness");
}

/// The sections of fabric that are plain settings.
template <class V>
void describeFabric(V& v, Settings& s)
{
    v.section("porous", s.porous, "");
    v.section("fabric", s.fabric, "");
    v.unsupported("contact",
                  "how hard solids push fabric follows from its mass and the step, with every solver; remove the section "
                  "(fabric.contact: false takes contact away, obstacles[].collide: false that with one solid)");
}

}  // namespace sim
