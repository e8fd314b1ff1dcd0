#pragma once

#include "app/live/recent_files.h"
#include "app/scene/changed_scene.h"

#include <optional>
#include <string>

namespace app {

/// What the user wants done with the scene as a whole.
struct SceneCommands {
    bool save = false;                       ///< whether the scene is to be saved, as YAML
    bool copyCommand = false;                ///< into the clipboard
    bool picture = false;                    ///< into a PNG
    std::optional<bool> record = {};         ///< every frame into a PNG, from now on or no longer
    std::optional<std::string> open = {};    ///< another scene's file
    std::optional<std::string> beside = {};  ///< a variant to be put beside; "" for none
};

/// Files and variants of the scene.
class ScenePanel {
 public:
    /// Into the window that is begun.
    SceneCommands draw(const LiveScene& scene, const RecentFiles& recent) const;

    bool isRecording = false;
    std::string beside;   ///< the variant that stands beside
    std::string message;  ///< message of what was done last, or why it was not
};

}  // namespace app
