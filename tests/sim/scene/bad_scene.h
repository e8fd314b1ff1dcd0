#pragma once

#include "app/scene/read_picture_settings.h"
#include "sim/scene/load_scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// A scene with one mistake, and the whole message that it gives.
struct BadScene {
    const char* name;
    const char* text;
    const char* message;
    std::string variant = {};
    std::vector<std::string> set = {};
};

inline void PrintTo(const BadScene& bad, std::ostream* out) { *out << bad.name; }

/// Loads it as the program does, simulation and pictures.
inline void expectItsMessage(const BadScene& bad)
{
    try {
        const sim::SceneFile file = sim::sceneFileFromText(bad.text, "bad.yaml", {bad.variant, bad.set});
        sim::readScene(file);
        app::readPictureSettings(file);
        FAIL() << "loaded";
    } catch (const sim::InputError& e) {
        EXPECT_STREQ(bad.message, e.what());
    }
}
