#pragma once

#include "app/import/import_report.h"
#include "app/import/reference_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// Sources, obstacles and the domain in the words of scenes.
struct ImportedBodies {
    struct Source {
        std::string name, shape;  ///< the shape as YAML on one line
        std::vector<reference::Emission> emissions;
        int line = 1;  ///< line of the file
    };
    struct Obstacle {
        std::string name, shape;
        bool inside = false, sampled = true;
        std::string motion;  ///< as YAML on one line; empty if it stands still
        int line = 1;
    };
    std::vector<Source> sources;
    std::vector<Obstacle> obstacles;
    std::string domain;  ///< empty if there is none
    int domainLine = 1;
    std::vector<std::filesystem::path> missingFiles;  ///< meshes that are not where the file says
};

/// @param xml   the file, for meshes beside or above it
/// @param yaml  the scene to be written, to which meshes are named relative
ImportedBodies importBodies(const reference::Scene& scene, const std::filesystem::path& xml, const std::filesystem::path& yaml, ImportReport& report);

/// The scripts of a group as a motion of scenes, on one line; empty if none moves anything.
/// @param center  what turns without an origin of its own turns about this [cm]
std::string motionText(const reference::Scene& scene, int group, const sim::Vec3& center, ImportReport& report);

}  // namespace app
