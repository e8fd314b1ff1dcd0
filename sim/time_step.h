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

/// Potential energy of halfway through the last step less that of the present places [erg], 0 after a step that reflects. With the
/// integrator reflected particles hold the velocities of then, and energies are those of then: taken at different times their sum would
/// swing by dt/2 times the power of the weight.
double staggeredPotentialOffset(const State& state, const Settings& settings);

}  // namespace sim
