#include "app/view/viewer.h"

#include "app/interrupt.h"
#include "app/scene_look.h"
#include "app/view/live_panel.h"
#include "app/view/view_camera.h"
#include "app/view/window.h"
#include "render/draw_targets.h"
#include "render/renderer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <optional>

namespace app {

struct Viewer::Inner {
    Inner(const SceneSetup& s, const Parts& parts, const ViewOptions& options)
        : setup(s),
          live(s, parts),
          window(fmt::format("{} - Drench", s.scene.title.empty() ? s.scene.name : s.scene.title), options.width,
                 options.height),
          renderer(window.context()),
          panel(s.pictures)
    {
        if (!options.paused) live.play();
    }

    const SceneSetup setup;
    LiveSimulation live;
    Window window;
    render::Renderer renderer;
    LivePanel panel;
    std::optional<ViewCamera> camera;  ///< once there is something to look at
    std::unique_ptr<FrameSnapshot> shown;
    std::filesystem::path screenshotFile;  ///< of the next frame; empty: none is wanted

    double aspect() const { return static_cast<double>(window.width()) / window.height(); }
    void takeNewest();
    void moveCamera();
    void followKeys();
    void frameAll();
    void draw();
    void writeScreenshot();
};

void Viewer::Inner::takeNewest()
{
    shown = live.takeSnapshot(std::move(shown));
    panel.add(live.takeSteps());
    if (!shown || camera || window.height() == 0) return;
    camera.emplace(cameraAt(setup.pictures.render.camera, shown->time, render::bounds(shown->view()), aspect()));
}

void Viewer::Inner::frameAll()
{
    if (shown) camera->frame(render::bounds(shown->view()), aspect());
}

void Viewer::Inner::moveCamera()
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse || !camera || io.DisplaySize.y <= 0.0f) return;
    const double right = io.MouseDelta.x / io.DisplaySize.y, up = -io.MouseDelta.y / io.DisplaySize.y;
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f)) camera->orbit(right, up);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0.0f) || ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0f))
        camera->pan(right, up);
    if (io.MouseWheel != 0.0f) camera->zoom(io.MouseWheel);
}

void Viewer::Inner::followKeys()
{
    if (ImGui::GetIO().WantCaptureKeyboard) return;
    for (const int key : window.keys()) {
        if (key == ' ') panel.playOrPause(live);
        if (key == 'S') live.stepOnce();
        if (key == 'R') live.restart();
        if (key == 'F' && camera) frameAll();
    }
}

void Viewer::Inner::draw()
{
    if (!shown || !camera || window.width() == 0 || window.height() == 0) return;
    renderer.show(shown->view(), camera->camera(), panel.lookFor(*shown),
                  {.width = window.width(), .height = window.height()});
}

void Viewer::Inner::writeScreenshot()
{
    if (screenshotFile.empty() || window.width() == 0 || window.height() == 0) return;
    render::writePng(render::readFramebuffer(window.context().gl(), 0, window.width(), window.height()),
                     screenshotFile);
    screenshotFile.clear();
}

Viewer::Viewer(const SceneSetup& setup, const Parts& parts, const ViewOptions& options)
    : inner_(std::make_unique<Inner>(setup, parts, options))
{
}

Viewer::~Viewer() = default;

bool Viewer::frame()
{
    Inner& in = *inner_;
    const bool goesOn = in.window.begin();
    in.takeNewest();
    in.panel.draw(in.live);
    in.moveCamera();
    in.followKeys();
    in.draw();
    in.window.drawPanels();
    in.writeScreenshot();
    in.window.present();
    return goesOn;
}

LiveStatus Viewer::status() const
{
    return inner_->live.status();
}

std::vector<std::string> Viewer::takeComplaints()
{
    return inner_->window.context().takeComplaints();
}

void Viewer::screenshot(const std::filesystem::path& file)
{
    inner_->screenshotFile = file;
}

void view(const SceneSetup& setup, const Parts& parts, const ViewOptions& options)
{
    Viewer viewer(setup, parts, options);
    while (viewer.frame() && interruptsSeen() == 0) {
    }
}

}  // namespace app
