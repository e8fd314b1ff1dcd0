#pragma once

#include "app/parts.h"
#include "app/view/live_simulation.h"

#include <filesystem>
#include <memory>

namespace app {

/// A window on a scene that is simulated while one looks at it. One per process; to be used by the thread that made it.
class Viewer {
 public:
    /// Throws InputError for what is wrong with the scene, RunError where there is no display or no OpenGL 3.3 core.
    Viewer(const SceneSetup& setup, const Parts& parts, const ViewOptions& options);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Take what the user did and draw the window anew. Never waits for a step. False once the window is to be closed.
    bool frame();
    LiveStatus status() const;
    /// Errors that OpenGL has told of since the last call, for tests.
    std::vector<std::string> takeComplaints();
    /// The next frame goes into a PNG file too, with its panels.
    void screenshot(const std::filesystem::path& file);

 private:
    struct Inner;
    std::unique_ptr<Inner> inner_;
};

/// Show a scene until its window is closed.
void view(const SceneSetup& setup, const Parts& parts, const ViewOptions& options);

}  // namespace app
