#pragma once

#include "sim/energy_book.h"
#include "sim/step.h"

// The liquid's part of a step, around that of the fabric.

namespace sim {

/// What a step of the liquid does beside the usual.
struct LiquidPlan {
    bool flips = false, reflects = false, relaxes = false, corrects = false;
    bool meetsFabric = false;  ///< is near enough to
    bool isMixed = false;      ///< with fabric on some faces
};

/// How long weight, viscosity and surface tension act on the velocities of a step of dt [s]. With the integrator reflected velocities are
/// those halfway through it: steps of any length then fall as far as they should. Not so near fabric, which bears its weight over dt: to
/// liquid and fabric that fall together gravity does the same when steps change their length.
double fallTime(const TimeSettings& time, const State& state, double dt, bool meetsFabric);
/// Gravity on the fabric over dt: what near liquid does to it what gravity does to the liquid over fallTime [cm/s^2].
Vec3 meanGravity(const Settings& settings, const State& state, double dt, bool meetsFabric);

/// The liquid up to its velocities on the grid; those on faces with fabric are the mixture's.
LiquidPlan startLiquid(State& state, const Scene& scene, Workspace& work, double dt, bool reflects, StepReport& report, StageClock& clock,
                       EnergyBook& energy);

/// The rest, when the fabric has done what it does.
void finishLiquid(State& state, const Scene& scene, Workspace& work, double dt, const LiquidPlan& plan, StepReport& report, StageClock& clock,
                  EnergyBook& energy);

}  // namespace sim
