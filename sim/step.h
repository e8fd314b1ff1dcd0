#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"
#include "sim/step_report.h"
#include "sim/workspace.h"

namespace sim {

/// Advance liquid and fabric by dt [s] (sim/README.md, The step). Throws RunError when a stage fails; Workspace::failedStage is that stage.
StepReport step(State& state, const Scene& scene, Workspace& work, double dt);

}  // namespace sim
