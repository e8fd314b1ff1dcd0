#include "app/view/saved_scene.h"

#include "app/read_picture_settings.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/section_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace app {

namespace {

/// As a shell reads it back.
std::string quoted(const std::string& text)
{
    const bool isPlain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || std::string_view("_-./=,:+").find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (isPlain) return text;
    std::string all = "'";
    for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return all + "'";
}

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
    std::string line = "drench run " + quoted(request.file);
    if (!request.variant.empty()) line += " --variant " + quoted(request.variant);
    for (const std::string& set : request.sets) line += " --set " + quoted(set);
    return line;
}

std::filesystem::path freeName(const std::string& stem, const std::string& extension)
{
    std::filesystem::path name = stem + extension;
    for (int n = 2; std::filesystem::exists(name); ++n) name = fmt::format("{}_{}{}", stem, n, extension);
    return name;
}

}  // namespace app
