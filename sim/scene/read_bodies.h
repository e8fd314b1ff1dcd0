#pragma once

#include "sim/scene/node.h"
#include "sim/scene/scene.h"

namespace sim {

/// Reads liquid.sources. Everything but the shapes' extent is checked; `settings` gives cell, start and spacing.
std::vector<SourceSettings> readSources(const Node& root, const Settings& settings);

/// Reads obstacles, with their motions: those inside them and those of the section `motion`, which names them.
std::vector<ObstacleSettings> readObstacles(const Node& root, const Settings& settings);

}  // namespace sim
