#pragma once

#include "app/scene/read_picture_settings.h"
#include "sim/scene/load_scene.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace test {

/// What holds for any text at all: it is a scene, and then reads back from what is printed of it, or is refused in one line
/// that names a file. True if it is a scene; std::logic_error where neither is so.
inline bool loadsOrComplains(const std::string& text, const std::string& name, const sim::LoadOptions& options = {})
{
    const auto printed = [&](const std::string& content) {
        const sim::SceneFile file = sim::sceneFileFromText(content, name, options);
        const sim::Scene scene = sim::readScene(file);
        return sim::printScene(scene) + app::printPictureSettings(app::readPictureSettings(file));
    };
    std::string once;
    try {
        once = printed(text);
    } catch (const sim::InputError& error) {
        const std::string message = error.what(), folder = name.substr(0, name.rfind('/') + 1);
        if (message.find('\n') != std::string::npos) throw std::logic_error("more than one line: " + message);
        if (!message.starts_with(folder.empty() ? name : folder)) throw std::logic_error("names no file: " + message);
        return false;
    }
    try {
        if (printed(once) != once) throw std::logic_error("what is printed reads as another scene:\n" + once);
    } catch (const sim::InputError& error) {
        throw std::logic_error(fmt::format("what is printed cannot be read: {}\n{}", error.what(), once));
    }
    return true;
}

}  // namespace test
