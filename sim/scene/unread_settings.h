#pragma once

#include "sim/scene/node.h"
#include "sim/scene/scene.h"

namespace sim {

/// Adds a note to the scene for every setting that its file gives a value other than its default and that nothing reads, as the others are:
/// "drop.yaml:4: transfer.flip_ratio: has no effect here; it goes with transfer.method flip". Where a file is of several runs, of what the
/// command line gives alone.
void noteUnreadSettings(const Node& root, Scene& scene);

}  // namespace sim
