#pragma once

#include "sim/settings.h"
#include "sim/state.h"

namespace sim {

struct Workspace;

/// Largest stable time step from here [s], by the scene's mode and bounds (sim/README.md, Length of a step), not yet fitted to a frame.
double chooseTimeStep(const Settings& settings, const State& state, double maxSpeed);

/// dt (max speed + sqrt(h |g|)) / h (sim/README.md, Length of a step).
double cflNumber(const Settings& settings, double maxSpeed, double dt);

/// Is the next step to reflect, if it is not the second of two? Liquid near fabric is not reflected.
bool mayReflect(const State& state, const TimeSettings& time, const Workspace& work);

/// With the integrator reflected, particles hold the velocities that they had halfway through their last step. Energies are those of
/// then: by this much the potential energy was above that of the present places [erg], 0 after a step that reflects. Taken at different
/// times their sum would swing by dt/2 times the power of the weight.
double staggeredPotentialOffset(const State& state, const Settings& settings);

}  // namespace sim
