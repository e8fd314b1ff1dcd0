#include "app/view/saved_scene.h"

#include "app/scene/read_picture_settings.h"
#include "app/system/child_process.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace app {

namespace {

}  // namespace

std::string savedScene(const LiveScene& live, const render::Camera& camera)
{
    PictureSettings pictures = live.setup.pictures;
    pictures.compare = {};
    CameraSettings& seen = pictures.render.camera;
    seen = {};
    seen.autoFrame = false;
    seen.eye = camera.eye;
    seen.lookAt = camera.target;
    seen.up = camera.up;
    seen.fovDegrees = camera.fovDegrees;
    return sim::printScene(live.setup.scene) + printPictureSettings(pictures);
}

std::string commandLine(const SceneRequest& request)
{
    std::string line = "drench run " + shellQuoted(request.file);
    if (!request.variant.empty()) line += " --variant " + shellQuoted(request.variant);
    for (const std::string& set : request.sets) line += " --set " + shellQuoted(set);
    return line;
}

std::filesystem::path freeName(const std::string& stem, const std::string& extension)
{
    std::filesystem::path name = stem + extension;
    for (int n = 2; std::filesystem::exists(name); ++n) name = fmt::format("{}_{}{}", stem, n, extension);
    return name;
}

}  // namespace app
