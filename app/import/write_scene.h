#pragma once

#include "app/import/imported_bodies.h"
#include "app/import/imported_fabric.h"
#include "app/import/scene_lines.h"
#include "app/options.h"

#include <functional>

namespace app {

/// All that a written scene is made of.
struct ImportedScene {
    std::string name;    ///< name of the scene, and of the files of its fabric
    std::string from;    ///< the XML's name
    std::string report;  ///< the name of the report beside the scene
    reference::Scene reference;
    std::vector<ImportedPiece> pieces;
    ImportedBodies bodies;
    std::vector<std::pair<int, std::string>> motions;  ///< motions of groups with pins, as YAML on one line
    const char* method = "apic";                       ///< method of the transfer
    bool vertexSolver = false;

    bool hasFabric() const { return !pieces.empty(); }
};

/// The scene as YAML. @param fileOf  the name to write for the file of a piece
SceneLines writeScene(const ImportedScene& scene, const std::function<std::string(const ImportedPiece&)>& fileOf);

/// Parts of writeScene.
void writeLiquid(const ImportedScene& scene, SceneLines& out);
void writeFabrics(const ImportedScene& scene, const std::function<std::string(const ImportedPiece&)>& fileOf, SceneLines& out);

/// The transfer that a file means, and the words why where that needs saying.
struct ChosenMethod {
    const char* name = "apic";
    std::string why;
};
ChosenMethod chosenMethod(const reference::Run& run, const ImportOptions& options);

}  // namespace app
