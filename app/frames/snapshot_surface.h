#pragma once

#include "app/frames/frame_snapshot.h"
#include "sim/state.h"

namespace app {

/// The surface of the liquid if `extras` ask for it, with the values they ask for; else nothing is left of it.
/// @param density  of the liquid [g/cm^3]
void takeSurface(const sim::State& state, double density, const SnapshotExtras& extras, FrameSnapshot::Surface& out);

}  // namespace app
