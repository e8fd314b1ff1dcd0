#pragma once

#include "sim/scene/variants.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

/// What of a scene file to load.
struct LoadOptions {
    std::string variant = {};           ///< name of the variant; empty: the scene as written
    std::vector<std::string> set = {};  ///< overrides "key.key=value", applied last
    ReadingBounds bounds = {};          ///< bounds of the file and all that it includes
};

/// One file as it stands.
struct SceneText {
    std::string file, text;
};

/// A scene file as one tree: includes merged, variant and overrides applied, nothing validated but syntax.
/// sim::readScene and app's settings of pictures read it, each their sections.
struct SceneFile {
    std::string file;                     ///< as the user named it
    Node root;                            ///< a map
    std::vector<SceneVariant> variants;   ///< all of them, as written in the file
    std::string variant;                  ///< the one applied; empty if none
    std::vector<std::string> notes = {};  ///< notes on keys that were called otherwise before
    std::vector<SceneText> texts;         ///< texts of the file, then of all that it includes
};

/// Reads a scene file: includes first, then the variant, then the overrides. Throws InputError.
SceneFile loadSceneFile(const std::filesystem::path& path, const LoadOptions& options = {});

/// Reads a scene from text in memory; `name` stands in messages, and includes are relative to its folder.
SceneFile sceneFileFromText(const std::string& text, const std::filesystem::path& name, const LoadOptions& options = {});

/// Names of the file's variants, in order.
std::vector<std::string> variantNames(const std::filesystem::path& path);

}  // namespace sim
