#pragma once

#include "app/frame_snapshot.h"
#include "app/picture_settings.h"
#include "sim/state.h"

namespace app {

/// Copy the liquid and the fabric of `state` and its time into `snapshot`, in single precision, reusing its storage.
/// @param fabric   what state.fabric is the state of
/// @param density  of the liquid [g/cm^3]; particles are drawn as balls of their mean volume
/// @param look     says which values colour the fabric: the speeds of vertices [cm/s], or their largest strain [-]
void takeSnapshot(const sim::State& state, const sim::Fabric& fabric, double density, const RenderSettings& look, FrameSnapshot& snapshot);

}  // namespace app
