#pragma once

#include "app/view/live_panel.h"
#include "app/view/look_panel.h"
#include "app/view/parameter_panel.h"
#include "app/view/probe_panel.h"
#include "app/view/scene_panel.h"
#include "app/view/view_camera.h"
#include "app/view/viewer.h"
#include "app/view/window.h"
#include "render/renderer.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace app {

/// Title of a window that shows a scene.
std::string windowTitle(const sim::Scene& scene);

/// What stands behind a Viewer. Its functions are in viewer.cpp (scenes and their pictures), viewer_panels.cpp and viewer_commands.cpp (what the user
/// wants done).
struct Viewer::Inner {
    Inner(const SceneRequest& asked, const Backends& p, const ViewOptions& options)
        : backends(p),
          request(asked),
          pair(std::make_unique<LivePair>(request, backends)),
          window(windowTitle(scene()), options.width, options.height),
          renderer(window.context())
    {
        isFirstUse = recent.files().empty();
        lookAtScene();
        if (!options.beside.empty()) addSecondSide(options.beside);
        if (!options.paused) pair->playOrPause();
    }

    const Backends backends;
    SceneRequest request;
    std::unique_ptr<LivePair> pair;
    Window window;
    render::Renderer renderer;
    LivePanel livePanel;
    ParameterPanel parameterPanel;
    ProbePanel probePanel;
    std::optional<LookPanel> lookPanel;
    ScenePanel scenePanel;
    RecentFiles recent;
    bool isFirstUse = false;                            ///< whether it is not seen yet that the user knows what to do
    std::size_t tuned = 0;                              ///< the side whose settings are shown
    std::optional<ViewCamera> camera;                   ///< camera, once there is something to look at
    std::filesystem::path screenshotFile, pictureFile;  ///< files of the next frame, with and without panels; or empty
    std::filesystem::path recordFolder;                 ///< folder of recorded frames
    std::int64_t recorded = -1;                         ///< number of the last one
    double fullSeconds = 0.0;                           ///< time that the last picture of full quality took

    const sim::Scene& scene() const { return pair->first().scene()->setup.scene; }
    LivePair::Side& tunedSide() { return *pair->sides()[std::min(tuned, pair->sides().size() - 1)]; }
    int widthOfPanels() const;
    int widthOfSide() const { return (window.width() - widthOfPanels()) / static_cast<int>(pair->sides().size()); }
    double aspect() const { return static_cast<double>(widthOfSide()) / window.height(); }
    bool isShowing() const { return camera && widthOfSide() > 0 && window.height() > 0; }

    void lookAtScene();
    void open(const std::string& file);
    void addSecondSide(const std::string& variant);
    void showRequested();
    void takeNewest();
    void moveCamera();
    void followKeys();
    void followKey(int key);
    void followControl(int key);
    void frameAll();
    void drawScenes();
    bool isChanging() const;
    void drawPanels();
    void drawFirstHint() const;
    void drawPicturePanel();
    void drawSettings();
    void follow(const SceneCommands& commands);
    void record(bool isOn);
    void save();
    void writePictures();
    void writeTo(const std::filesystem::path& file);
};

}  // namespace app
