#pragma once

#include <string>

namespace app {

struct ViewOptions {
    int width = 1280, height = 800;  ///< of the window [screen units]
    bool paused = false;             ///< wait with the first step until somebody asks for it
    std::string beside = {};         ///< a variant of the scene to be shown beside it; empty: none
};

}  // namespace app
