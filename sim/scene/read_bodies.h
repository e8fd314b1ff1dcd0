#pragma once

#include "sim/scene/node.h"
#include "sim/scene/scene.h"

namespace sim {

/// Reads liquid.sources, of which there must be one where it `isNeeded`. Everything but the shapes' extent is checked;
/// `settings` gives cell, start and spacing.
std::vector<SourceSettings> readSources(const Node& root, const Settings& settings, bool isNeeded);

/// Reads liquid.openings. What they need of domain and gravity is checked, but not whether obstacles leave anything of them open.
std::vector<OpeningSettings> readOpenings(const Node& root, const Settings& settings, const std::optional<Shape>& domain);

/// Reads obstacles and the motions that stand in them.
std::vector<ObstacleSettings> readObstacles(const Node& root, const Settings& settings);

}  // namespace sim
