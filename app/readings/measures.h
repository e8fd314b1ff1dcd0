#pragma once

#include "app/readings/force_log.h"
#include "sim/core/types.h"
#include "sim/particles/liquid_particles.h"
#include "sim/scene/formula.h"
#include "sim/shapes/motion.h"

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace app {

class SimulationHandle;

/// A plane, or the disc of it within a radius, through which liquid goes.
struct ControlSurface {
    sim::Vec3 center = sim::Vec3::Zero();                     ///< [cm]
    sim::Vec3 normal = sim::Vec3::UnitY();                    ///< normal of length 1
    double radius = std::numeric_limits<double>::infinity();  ///< [cm]
    sim::Motion motion = {};                                  ///< motion of the obstacle that it moves with

    /// The surface where it is at a time [s].
    ControlSurface at(double time) const
    {
        const Eigen::Isometry3d place = motion.transform(time);
        return {place * center, place.linear() * normal, radius, motion};
    }
};

/// Pressures on discs, summed up over steps that follow each other.
struct PressureTotals {
    double time = 0.0;         ///< [s]
    std::vector<double> sums;  ///< sums of each disc that is read, by their names in order: pressure times time [dyn s/cm^2]
};

/// What readings of steps are before the first one: 0, or none.
enum class BeforeSteps { Zero, None };

/// A reading of steps before the first one has been taken.
struct NoStepYet : sim::FormulaError {
    NoStepYet() : FormulaError("there was no step yet") {}
};

/// What is summed up since the last reading.
struct IntervalTotals {
    ForceTotals forces;
    PressureTotals pressures;
};

/// What a formula of a validation or a probe can read of a simulation as it is, in cgs. With a for x, y, z:
///  * liquid: liquid_mass, left_mass (that left the domain), liquid_a (centre of mass), liquid_va (its velocity), spin_a (angular
///    momentum about it), speed (largest), rms_speed, kinetic, potential, energy and momentum_a (of everything), wave_a(k) (mean of
///    cos k a), mass_a(from, to) (of liquid between two planes);
///  * heights: surface_x(y, z), surface_y(x, z) and surface_z(x, y) (where the liquid ends on the line through a point, upwards along the axis
///    [cm]: the highest place where its density, smoothed over a cell, is half of the densest there; no value where there is no liquid);
///  * at a point: velocity_a(x, y, z) (mean of the liquid within a cell of it, no value where there is none), saturation_at(x, y, z) (of the
///    vertex of fabric next to it);
///  * of control surfaces: flux("outlet") (liquid that goes through [g/s]), pressure_on("sensor") (of a disc: mean over it, and over the steps
///    since the last reading; a disc at a wall has the pressure of the liquid beside it, half a cell from the wall [dyn/cm^2]);
///  * on the grid of the last step: pressure(x, y, z) (that of this step alone: the second of two, of which the first reflects,
///    has hardly any part of what stops moving liquid; pressure_on has it), front_x(y), front_z(y), front_y(x) (middle
///    of the last cell of those with liquid that hang together with the first along x, z or y; no value where there is none), and with `flow`
///    flow_error (rms distance of velocities from it, relative to it) and flow_part (how much of it there is);
///  * fabric: fabric_mass (dry), absorbed, fabric_a, fabric_va, fabric_speed (largest), fabric_kinetic, elastic,
///    saturation(number of a vertex), vertex_a(number), vertex_va(number), spread_a (from its lowest to its highest
///    vertex), wet_a(saturation) (from the lowest to the highest of vertices whose pores are that full), shadow_a("sheet") (area of the shadow
///    of a cloth in light along the axis [cm^2]);
///  * forces [dyn] and torques about the origin [dyn cm], means over the steps since the last reading: force_a("ball") and
///    torque_a("ball") of an obstacle or a fabric by liquid and contact together, liquid_force_a, liquid_torque_a, contact_force_a and
///    contact_torque_a by one of them, pin_force_a("sheet") and pin_torque_a by a fabric on all its pins, or on those of that name.
/// What is of the last step or of those since the last reading is before the first step 0 in validations, and has no value in probes.
class Measures {
 public:
    explicit Measures(const sim::Scene& scene, BeforeSteps beforeSteps = BeforeSteps::Zero)
        : density_(scene.settings.liquid.density), beforeSteps_(beforeSteps), forceNames_(scene)
    {
    }
    Measures(const Measures&) = delete;
    Measures& operator=(const Measures&) = delete;

    /// Names for formulas; they look at what this looks at.
    std::vector<sim::FormulaNames::Function> names();
    std::vector<sim::FormulaNames::OfName> forces();
    void look(const SimulationHandle& simulation)
    {
        simulation_ = &simulation;
        startInterval();
    }
    /// Looks at a simulation in the middle of an interval.
    void setSimulation(const SimulationHandle& simulation) { simulation_ = &simulation; }
    void addControlSurface(const std::string& name, const ControlSurface& surface) { controlSurfaces_[name] = surface; }
    sim::FormulaNames::OfName flux();
    sim::FormulaNames::OfName pressures();
    std::vector<sim::FormulaNames::OfName> shadows();
    /// Readings of forces, and of pressures on discs, are means over the steps that were taken since.
    void startInterval() { interval_ = {}; }
    void afterStep();
    const IntervalTotals& interval() const { return interval_; }
    void setInterval(const IntervalTotals& interval) { interval_ = interval; }
    /// Formulas of x, y, z, t.
    void setFlow(std::array<sim::Formula, sim::kAxes> flow) { flow_ = std::move(flow); }

 private:
    using Names = std::vector<sim::FormulaNames::Function>;
    void addLiquid(Names& names);
    void addLiquidAlong(int axis, Names& names);
    void addFlow(Names& names);
    void addPoints(Names& names);
    void addFabric(Names& names);
    void addFabricAlong(int axis, Names& names);
    double valueBeforeSteps() const;
    double momentum(int axis) const;
    const sim::LiquidParticles& liquid() const;
    std::size_t vertex(double number) const;
    sim::Vec3 flowAt(const sim::Vec3& x) const;
    template <class Term>
    double sumOverFaces(Term&& term) const;
    double flowError() const;
    double flowPart() const;
    double pressureAt(const sim::Vec3& x) const;
    void sumPressures();
    double meanPressureOn(const std::string& name);
    double surfaceAt(int axis, double b, double c) const;
    double velocityAt(int axis, const sim::Vec3& x) const;
    double saturationAt(const sim::Vec3& x) const;
    double fluxThrough(const ControlSurface& resting) const;
    double front(int axis, double where) const;
    double shadowOf(const std::string& name, int axis) const;

    sim::Impulse meanOn(const std::string& name, bool byLiquid, bool byContact) const;
    sim::Impulse meanOnPins(const std::string& name) const;

    double density_;  ///< density of the liquid [g/cm^3]
    BeforeSteps beforeSteps_;
    ForceNames forceNames_;
    IntervalTotals interval_;
    std::map<std::string, ControlSurface> controlSurfaces_;
    std::set<std::string> discs_;  ///< names of those on which formulas read pressures
    const SimulationHandle* simulation_ = nullptr;
    std::optional<std::array<sim::Formula, sim::kAxes>> flow_;
};

}  // namespace app
