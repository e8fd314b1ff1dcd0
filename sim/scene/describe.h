#pragma once

#include "sim/scene/choice.h"
#include "sim/scene/describe_coupling.h"
#include "sim/scene/range.h"
#include "sim/scene/scene.h"
#include "sim/scene/units.h"
#include "sim/settings.h"

#include <algorithm>
#include <span>
#include <string_view>

// The one declaration of every key of a scene: where it is stored, unit, range, one line of help. Visitors do the rest:
// SectionReader (YAML → struct), KeyList (what keys there are), SectionWriter (struct → commented YAML), ParameterList (struct → what a
// panel shows).

namespace sim {

inline std::span<const Choice<TimeMode>> choicesOf(TimeMode)
{
    static constexpr Choice<TimeMode> kAll[] = {{"fixed", TimeMode::Fixed}, {"cfl", TimeMode::Cfl}, {"adaptive", TimeMode::Adaptive}};
    return kAll;
}

inline std::span<const Choice<TimeIntegrator>> choicesOf(TimeIntegrator)
{
    static constexpr Choice<TimeIntegrator> kAll[] = {{"plain", TimeIntegrator::Plain}, {"reflected", TimeIntegrator::Reflected}};
    return kAll;
}

inline std::span<const Choice<TransferMethod>> choicesOf(TransferMethod)
{
    static constexpr Choice<TransferMethod> kAll[] = {
        {"pic", TransferMethod::Pic}, {"flip", TransferMethod::Flip}, {"apic", TransferMethod::Apic}, {"polypic", TransferMethod::PolyPic}};
    return kAll;
}

inline std::span<const Choice<XiMap>> choicesOf(XiMap)
{
    static constexpr Choice<XiMap> kAll[] = {
        {"translation", XiMap::Translation}, {"affine", XiMap::Affine}, {"affine_conservative", XiMap::AffineConservative}};
    return kAll;
}

inline std::span<const Choice<FillSettings::Pattern>> choicesOf(FillSettings::Pattern)
{
    using P = FillSettings::Pattern;
    static constexpr Choice<P> kAll[] = {{"lattice", P::Lattice}, {"reference", P::Reference}, {"jittered", P::Jittered}, {"poisson", P::Poisson}};
    return kAll;
}

template <class V>
void visitFields(V& v, TimeSettings& t)
{
    v.number("dt", t.dt, Quantity::Time, Range::above(0.0), "Time step; its upper bound in modes cfl and adaptive");
    v.fixed([&](auto& w) {
        w.number("duration", t.duration, Quantity::Time, Range::atLeast(0.0), "Simulated time from start to end");
        w.number("start", t.start, Quantity::Time, Range::any(), "Time of the initial state");
    });
    v.choice("mode", t.mode, "How steps are chosen; adaptive: as cfl, and a bad step is rejected and made again half as long");
    v.number("cfl", t.cfl, Quantity::None, Range::above(0.0), "Cells a particle may cross per step, modes cfl and adaptive");
    v.group("max_cfl", "Hard bounds on the cells crossed per step, in every mode", [&](auto& w) {
        w.number("liquid", t.maxCflLiquid, Quantity::None, Range::above(0.0), "Bound of the liquid");
        w.number("fabric", t.maxCflFabric, Quantity::None, Range::above(0.0), "Bound of the fabric, solver grid only");
    });
    v.number("dt_min", t.dtMin, Quantity::Time, Range::above(0.0), "A run that needs smaller steps stops with a message");
    v.require(t.dtMin <= t.dt, "dt_min", "must not be above time.dt");
    v.choice("integrator", t.integrator, "How advection and pressure take turns");
}

template <class V>
void describeTransfer(V& v, TransferSettings& liquid, FabricTransferSettings& fabric)
{
    const Range share = Range::between(0.0, 1.0);
    v.perPhase("method", liquid.method, fabric.method,
               [](auto& w, const char* key, TransferMethod& m) { w.choice(key, m, "How velocities go to the grid and back"); });
    v.perPhase("modes", liquid.modes, fabric.modes, [](auto& w, const char* key, int& m) {
        const bool isFabrics = std::string_view(key) == "fabric";
        w.integer(key, m, 1, isFabrics ? FabricTransferSettings::kMostModes : 27,
                  isFabrics ? "Velocity modes per component, polypic only"
                            : "Velocity modes per component, polypic only; more than 8 amid the liquid only");
    });
    v.perPhase("xi", liquid.xi, fabric.xi,
               [](auto& w, const char* key, XiMap& xi) { w.choice(key, xi, "How modes move with the particle, polypic only"); });
    v.number("flip_ratio", liquid.flipRatio, Quantity::None, share, "FLIP share kept over damping_dt, flip only");
    v.group("damping", "Shares lost over damping_dt; 0 = no damping", [&](auto& w) {
        w.number("liquid_affine", liquid.affineDamping, Quantity::None, share, "Of all modes of the liquid but the mean");
        w.number("fabric_stretch", fabric.stretchDamping, Quantity::None, share, "Of the fabric's stretching rate");
        w.number("fabric_rotation", fabric.rotationDamping, Quantity::None, share, "Of the fabric's rotation rate");
        w.number("fabric_velocity", fabric.velocityDamping, Quantity::None, share, "Of the fabric's velocity");
    });
    v.numberOrWord("damping_dt", {liquid.dampingDt, "step", liquid.dampingPerStep}, Quantity::Time, Range::above(0.0),
                   "Time step to which flip_ratio and damping refer; step: they hold per step, however long it is");
    v.flag("damp_modes", liquid.dampModes, "damping acts on PolyPIC modes too");
    v.whenReading([&](auto&) {
        if (fabric.method == TransferMethod::Flip) fabric.method = TransferMethod::Apic;
        fabric.modes = std::min(fabric.modes, FabricTransferSettings::kMostModes);
    });
}

template <class V>
void visitFields(V& v, RelaxSettings& r)
{
    v.number("rate", r.rate, Quantity::Frequency, Range::atLeast(0.0), "Rate at which crowded particles are pushed apart; 0 = off");
    v.number("range", r.range, Quantity::None, Range::aboveTo(0.0, 10.0), "Reach of the push in nominal particle radii");
}

template <class V>
void visitFields(V& v, VolumeSettings& s)
{
    v.number("rate", s.rate, Quantity::Frequency, Range::atLeast(0.0),
             "Rate at which cells that hold too much liquid expand and holes in it close; 0 = off");
}

/// Constants that go together.
struct LiquidPreset {
    const char* name;
    double density, viscosity, surfaceTension;  ///< [g/cm^3], [P], [dyn/cm]
};
std::span<const LiquidPreset> liquidPresets();

class SectionReader;

/// Sets the material constants that `preset` names, if the section has it; "none" changes nothing.
void readLiquidPreset(const SectionReader& section, LiquidSettings& liquid);

template <class V>
void visitFields(V& v, LiquidSettings& l)
{
    v.other("preset", "Sets the next constants: water | oil | honey | acetal | none");
    v.whenReading([&](auto& reader) { readLiquidPreset(reader, l); });
    v.fixed([&](auto& w) { w.number("density", l.density, Quantity::Density, Range::above(0.0), "Mass per volume"); });
    v.number("viscosity", l.viscosity, Quantity::Viscosity, Range::atLeast(0.0), "Dynamic viscosity");
    v.number("surface_tension", l.surfaceTension, Quantity::SurfaceTension, Range::atLeast(0.0), "Surface tension against air");
    v.number("contact_angle", l.contactAngle, Quantity::Angle, Range::between(0.0, 180.0), "Angle of the surface at fibres");
    v.fixed([&](auto& w) {
        w.numberOr("particle_spacing", l.particleSpacing, 0.0, Quantity::None, Range::aboveTo(0.0, 1.0),
                   "Pitch of the particles in cells; left out: 0.4, or 0.35355 for the reference pattern");
        w.flag("full", l.full, "The liquid fills a closed box: there is no air");
    });
    v.number("wall_friction", l.wallFriction, Quantity::None, Range::between(0.0, 1.0), "0 = free slip, 1 = the liquid sticks to walls");
    v.integer(
        "surface_order", l.surfaceOrder, 1, 2,
        "2: the free surface moves as it should, where all solids are boxes around it, in planes of the grid, that it slips along; 1: waves are too "
        "slow by the cells' smearing, as published, and as beside other solids");
    v.section("volume", l.volume, "Keeping the liquid's volume");
    v.section("relax", l.relax, "Pushing crowded particles apart");
    v.flag("solve_viscosity", l.solveViscosity, "Viscosity inside the liquid");
    v.flag("surface_tension_force", l.surfaceTensionForce, "Surface tension moves the liquid");
    v.integer("curvature_smoothing", l.curvatureSmoothing, 0, 1000, "Smoothing passes over the fill before its curvature is taken");
    v.integer("viscosity_substeps", l.viscositySubsteps, 1, 1000, "Parts of a step, each of which viscosity is solved for");
    v.other("sources", "Where liquid starts");
    v.other("openings", "Faces of the domain through which it comes and goes");
}

template <class V>
void visitFields(V& v, SolverSettings& s)
{
    v.number("pressure_tolerance", s.pressureTolerance, Quantity::None, Range::aboveTo(0.0, 0.1),
             "Largest residual relative to the largest right-hand side");
    v.integer("max_iterations", s.maxIterations, 1, 1'000'000, "Iterations after which a solve stops");
    v.number("viscosity_tolerance", s.viscosityTolerance, Quantity::None, Range::aboveTo(0.0, 0.1),
             "Largest residual of the viscosity solve relative to the largest momentum of a face");
    v.integer("wicking_substeps", s.wickingSubsteps, 1, 1000,
              "Least number of parts of a step of the flow inside fabric; stability may ask for more");
}

template <class V>
void describeNames(V& v, Scene& s)
{
    v.text("name", s.name, "Name of the scene, and of the folder of its results");
    v.text("title", s.title, "As pictures show it");
    v.text("description", s.description, "What it shows");
    v.texts("tags", s.tags, "Words to find it by");
}

/// What `fill` of a source says; `spacing` 0 stands for liquid.particle_spacing or the pattern's own.
template <class V>
void visitFields(V& v, FillSettings& f)
{
    v.choice("pattern", f.pattern, "How particles are laid out");
    v.seed("seed", f.seed, "Start of the random numbers");
    v.numberOr("spacing", f.spacing, 0.0, Quantity::None, Range::aboveTo(0.0, 1.0), "Pitch of the particles in cells");
}

template <class V>
void visitFields(V& v, Emission& e)
{
    v.number("from", e.from, Quantity::Time, Range::any(), "Begin of the span; left out: the start of the run");
    v.required("to", "the end of the span in which the source gives liquid, like to: 0.5");
    v.number("to", e.to, Quantity::Time, Range::any(), "End of the span");
    v.numberOr("max_volume", e.maxVolume, std::numeric_limits<double>::infinity(), Quantity::Volume, Range::above(0.0),
               "The source stops when it has given so much");
    v.vector("velocity", e.velocity, Quantity::Velocity, "Velocity of the new liquid");
}

/// Faces of the domain, by axis, the lower one first.
enum class DomainFace { LowerX, UpperX, LowerY, UpperY, LowerZ, UpperZ };
inline std::span<const Choice<DomainFace>> choicesOf(DomainFace)
{
    using F = DomainFace;
    static constexpr Choice<F> kAll[] = {{"x-", F::LowerX}, {"x+", F::UpperX}, {"y-", F::LowerY},
                                         {"y+", F::UpperY}, {"z-", F::LowerZ}, {"z+", F::UpperZ}};
    return kAll;
}

template <class V>
void visitFields(V& v, OpeningSettings& o)
{
    DomainFace face = static_cast<DomainFace>(2 * o.axis + (o.isUpper ? 1 : 0));
    v.required("face", "the face of the domain that liquid passes, like face: x+");
    v.choice("face", face, "Face of the domain");
    o.axis = static_cast<int>(face) / 2;
    o.isUpper = static_cast<int>(face) % 2 == 1;
    v.numberOr("velocity", o.velocity, 0.0, Quantity::Velocity, Range::above(0.0),
               "Mean velocity at which liquid comes in; left out: liquid goes out, and in where it is drawn");
    v.numberOr("level", o.level, std::numeric_limits<double>::infinity(), Quantity::Length, Range::any(),
               "Height, against gravity, up to which liquid stands beyond the face; an inlet without it fills the face");
}

/// The sections of a scene that are plain settings.
template <class V>
void visitFields(V& v, Settings& s)
{
    v.section("time", s.time, "");
    v.group("transfer", "", [&](auto& w) { describeTransfer(w, s.transfer, s.fabricTransfer); });
    v.required("grid", "where the size of cells stands, like grid: {cell: 0.288}");
    v.group("grid", "", [&](auto& w) {
        w.required("cell", "the edge of a grid cell, like cell: 0.288");
        w.fixed([&](auto& f) { f.number("cell", s.cell, Quantity::Length, Range::above(0.0), "Edge of a grid cell"); });
    });
    v.vector("gravity", s.gravity, Quantity::Acceleration, "Acceleration of everything");
    v.section("coupling", s.coupling, "");
    v.section("solver", s.solver, "");
}

/// Sections of scenes whose builders are not in this version: refused by name, so that nothing is silently left out.
template <class V>
void describeLater(V& v)
{
    v.unsupported("sinks", "liquid goes out through an outlet in liquid.openings; domain deletes what falls out of a shape");
}

}  // namespace sim
