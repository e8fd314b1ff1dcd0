#pragma once

#include "app/scene/picture_settings.h"
#include "sim/scene/scene.h"
#include "sim/scene/scene_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// Which scene the user asked for.
struct SceneRequest {
    std::string file;
    std::string variant;                   ///< one of the scene's; empty: the file as written
    std::vector<std::string> sets;         ///< "dotted.key=value", applied last
    std::optional<std::string> text = {};  ///< what stands in for the content of the file, which is not read then
};

/// One scene file, read and resolved, with what it says about pictures and files.
struct LoadedScene {
    sim::Scene scene;
    PictureSettings pictures;
    std::string variant = "default";  ///< names its output folder
    std::string label;                ///< stands in its pictures; empty where the file is run as written
    std::string resolved;             ///< every setting with its unit, as `check` prints it
    std::string identity;             ///< the part of it that the run itself depends on: equal text, equal run
    SceneRequest request;             ///< what was asked for
    sim::SceneFile file;              ///< as written, with what it includes: what readings and experiments need is read there
};

/// What makes two runs the same: the resolved scene, how its pictures are drawn, and the program that ran it, as 16
/// hexadecimal digits.
std::string contentHash(const LoadedScene& setup, bool asPanel, std::uint64_t programHash);

/// Hash of this program's own file: another build may give other results.
std::uint64_t programHash();

std::string hexDigits(std::uint64_t value);

/// Where a run's results go unless --out says so: the scene's output.dir, with {name} and {variant} filled in, else
/// out/<name>/<variant>.
std::filesystem::path defaultFolder(const LoadedScene& setup);

/// Where the products of a comparison go unless --out says so, with a folder per variant below: the same without
/// {variant}, and under the comparison's own name if it has one.
std::filesystem::path defaultComparisonFolder(const LoadedScene& setup);

/// Tells the user what was mended in the scene's files, and what in them asks for nothing.
void logNotes(const LoadedScene& setup);

/// Frames after the initial one that the scene asks for.
std::int64_t frameCount(const LoadedScene& setup);

/// Number of the last frame at or before a simulated time [s].
std::int64_t lastFrameUpTo(const LoadedScene& setup, double time);

/// Simulated time of a frame [s]; frame 0 is the initial state.
double frameTime(const LoadedScene& setup, std::int64_t frame);

}  // namespace app
