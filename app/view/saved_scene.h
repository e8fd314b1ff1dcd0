#pragma once

#include "app/scene/changed_scene.h"
#include "render/camera.h"

#include <filesystem>
#include <string>

namespace app {

/// A scene file whose run repeats what was done live, seen as by the camera. Variants of the scene and what it is
/// checked against are left out.
std::string savedScene(const LiveScene& live, const render::Camera& camera);

/// The command that runs it, for a shell.
std::string commandLine(const SceneRequest& request);

/// The first of `stem.ext`, `stem_2.ext`, … in the present folder that does not exist.
std::filesystem::path freeName(const std::string& stem, const std::string& extension);

}  // namespace app
