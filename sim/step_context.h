#pragma once

#include "sim/energy_budget.h"
#include "sim/liquid/walls.h"
#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/step_report.h"
#include "sim/workspace.h"

namespace sim {

/// What the stages of a step find out about it, for those that follow.
struct StepPlan {
    bool isWet = false;           ///< there is liquid
    bool reflects = false;        ///< whether this is the first of two steps, whose velocities are reflected about the projected ones
    bool relaxes = false;         ///< particles are pushed apart
    bool correctsVolume = false;  ///< the liquid's volume is corrected
    bool fabricIsWet = false;     ///< fabric holds liquid
    // How far the liquid's cells and the system of its pressure have come, where there is liquid (liquid/cells.h, liquid/pressure.h).
    std::optional<SurfaceCells> surfaceCells;
    std::optional<SurfaceSteps> surfaceSteps;  ///< steps of the pressure at the surface, where surface tension acts
    std::optional<PressureSystem> pressure;
    std::optional<HeldBodies> heldBodies;
    // The fabric in the liquid.
    SortedVertices* vertices = nullptr;               ///< vertices in cells of the liquid; null where there are none
    std::optional<LiquidAround::Found> aroundFabric;  ///< what these see of the liquid, where anything goes by that
    std::optional<Capture::Uptake> uptake;            ///< what the fabric has taken up
    // How far the mixture of liquid and fabric has come, where both are on some faces (Mixture).
    std::optional<Mixture::SharedFaces> sharedFaces;
    std::optional<Mixture::EliminatedDrag> eliminatedDrag;
    std::optional<Mixture::AppliedPressure> appliedPressure;
    std::optional<Mixture::SeparatedPhases> separatedPhases;

    /// Is liquid within reach of fabric?
    bool overlapsFabric() const { return vertices != nullptr; }
    /// Are liquid and fabric on some faces both?
    bool isMixed() const { return sharedFaces.has_value(); }
};

/// A step under way: what it works on, and what its stages tell each other.
struct StepContext {
    const Scene& scene;
    State& state;
    Workspace& work;
    double dt;  ///< [s]
    StepReport& report;
    StageClock& clock;
    EnergyBudget energy{state, scene.settings, work, report};
    StepPlan plan{};

    const Settings& settings() const { return scene.settings; }
    CutGrid cut() const { return {state.grid, work.obstacleField, work.obstacles}; }
    bool hasObstacles() const { return !work.obstacles.empty(); }
    /// Do plane walls mirror the liquid?
    bool mirrorsAtWalls() const { return hasObstacles() && usesMirrorBoundary(settings().liquid.wallFriction); }
    bool isFlip() const { return settings().transfer.method == TransferMethod::Flip; }
    bool isViscous() const { return plan.isWet && settings().liquid.solveViscosity && settings().liquid.viscosity > 0.0; }
    /// May what holds liquid move?
    bool isFrameMoving() const { return plan.isMixed() || work.obstacles.anyMoving(); }
    /// Does the free surface move without the inertia of stretching?
    bool correctsStrain() const { return plan.isWet && work.correctsStrain; }
    /// Are the velocities straight after P2G needed after the pressure?
    bool keepsAdvected() const { return isFlip() || plan.reflects || work.correctsStrain; }

    /// How long weight, viscosity and surface tension act on the velocities of the liquid [s]. With the integrator reflected velocities are
    /// those halfway through the step: steps of any length then fall as far as they should. Not so near fabric, which bears its weight over dt:
    /// to liquid and fabric that fall together gravity does the same when steps change their length.
    double fallTime() const
    {
        const bool isFirst = state.lastDt == 0.0;
        return settings().time.reflects() && (isFirst || !plan.overlapsFabric()) ? 0.5 * (state.lastDt + dt) : dt;
    }
    /// Gravity on the fabric over dt: what near liquid does to it what gravity does to the liquid over fallTime [cm/s^2].
    Vec3 gravityOnFabric() const { return plan.overlapsFabric() ? Vec3(settings().gravity * (fallTime() / dt)) : settings().gravity; }
};

}  // namespace sim
