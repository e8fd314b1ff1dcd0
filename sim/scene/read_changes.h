#pragma once

#include "sim/scene/node.h"
#include "sim/scene/scene.h"

#include <string>
#include <vector>

namespace sim {

/// All plain settings of a scene and its materials (load_scene.cpp). Throws InputError.
void readSettings(const Node& root, Settings& settings, std::vector<NamedMaterial>& materials);

/// What `changes` of a scene says: a list of {step: n, set: {dotted key: value}}, each on top of those before it.
/// Throws InputError also for what cannot change during a run.
std::vector<SettingsChange> readChanges(const Node& root, const Scene& scene);

/// What the i-th change of a scene sets, each as `--set` takes it.
std::vector<std::string> changedSettings(const Scene& scene, std::size_t i);

/// An element of that list, on one line.
std::string changeText(std::int64_t step, const std::vector<std::string>& sets);

}  // namespace sim
