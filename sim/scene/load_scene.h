#pragma once

#include "sim/scene/scene.h"
#include "sim/scene/scene_file.h"

#include <filesystem>
#include <string>

namespace sim {

/// Reads a scene file: includes, then the variant, then the overrides; then everything is checked, nothing is left
/// half-read. Every mistake of the user is one InputError "file:line: what, and what would do".
Scene loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

/// The simulation's part of a scene file; the sections of pictures and products are read by the app from the same tree.
Scene readScene(const SceneFile& file);

/// The resolved scene as commented YAML in cgs, which loads again to the same scene. Ends before render, output,
/// compare.
std::string printScene(const Scene& scene);

}  // namespace sim
