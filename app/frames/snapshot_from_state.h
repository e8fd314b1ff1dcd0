#pragma once

#include "app/frames/frame_snapshot.h"
#include "app/scene/picture_settings.h"
#include "sim/fabric/contact/contact.h"
#include "sim/state.h"

namespace app {

/// What a scene's file asks for.
SnapshotExtras extrasOf(const RenderSettings& settings);

/// Copy the liquid and the fabric of `state` and its time into `snapshot`, in single precision, reusing its storage.
/// @param fabric   what state.fabric is the state of
/// @param contacts  between fabric and fabric, of the last step; null where there are none
/// @param density   of the liquid [g/cm^3]; particles are drawn as balls of their mean volume
/// @param extras    which values colour liquid and fabric, and which lines there are over them
void fillSnapshot(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, double density,
                  const SnapshotExtras& extras, FrameSnapshot& snapshot);

}  // namespace app
