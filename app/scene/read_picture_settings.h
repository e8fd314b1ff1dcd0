#pragma once

#include "app/scene/picture_settings.h"
#include "sim/scene/scene.h"
#include "sim/scene/scene_file.h"

#include <string>

namespace app {

/// Reads the sections render, output and compare of a scene file. Throws sim::InputError.
PictureSettings readPictureSettings(const sim::SceneFile& file);

/// What there is to draw in a scene.
SceneContents contentsOf(const sim::Scene& scene);

/// The sections render, output and compare as commented YAML in cgs: goes behind sim::printScene and loads again to the same settings.
std::string printPictureSettings(const PictureSettings& settings);

}  // namespace app
