#pragma once

#include "app/frame_snapshot.h"
#include "sim/state.h"

namespace app {

/// Copy the liquid of `state` and its time into `snapshot`, in single precision, reusing its storage.
/// @param density  of the liquid [g/cm^3]; particles are drawn as balls of their mean volume
void takeSnapshot(const sim::State& state, double density, FrameSnapshot& snapshot);

}  // namespace app
