#pragma once

#include "app/backends.h"
#include "app/live/live_pair.h"
#include "app/options.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace app {

/// A window on a scene that is simulated while one looks at it. One per process; to be used by the thread that made it.
class Viewer {
 public:
    /// Throws InputError for what is wrong with the scene, RunError where there is no display or no OpenGL 3.3 core.
    Viewer(const SceneRequest& request, const Backends& backends, const ViewOptions& options);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Take what the user did and draw the window anew. Never waits for a step. False once the window is to be closed.
    bool frame();
    LivePair& pair();
    /// Look at another scene, as when its file is dropped on the window. What is wrong with it is told there.
    void open(const std::string& file);
    void record(bool isOn);  ///< every frame into a PNG
    /// The next frame goes into a PNG file too, with its panels.
    void screenshot(const std::filesystem::path& file);
    /// Where the value of a setting stands in the window [pixels], if it is to be seen.
    std::optional<std::array<float, 2>> placeOf(const std::string& setting) const;
    std::string message() const;                ///< message that the window shows of what was done last
    std::vector<std::string> takeGlMessages();  ///< messages of OpenGL, since the last call

 private:
    struct Inner;
    std::unique_ptr<Inner> inner_;
};

/// Show a scene until its window is closed.
void view(const SceneRequest& request, const Backends& backends, const ViewOptions& options);

}  // namespace app
