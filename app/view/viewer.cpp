#include "app/view/viewer.h"

#include "app/drawing/look_from_settings.h"
#include "app/system/interrupt.h"
#include "app/system/stopwatch.h"
#include "app/view/viewer_inner.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace app {

namespace {

constexpr double kLongestWait = 0.1;  ///< longest wait for a picture of full quality while something changes [s]

std::string labelOf(const LoadedScene& setup) { return setup.label.empty() ? "as written" : setup.label; }

SceneRequest withVariant(SceneRequest request, const std::string& variant)
{
    if (!variant.empty()) request.variant = variant;
    return request;
}

}  // namespace

std::string windowTitle(const sim::Scene& scene) { return fmt::format("{} - Drench", scene.title.empty() ? scene.name : scene.title); }

/// The window begins with what the scene's file says of its pictures.
void Viewer::Inner::lookAtScene()
{
    const auto live = pair->first().scene();
    lookPanel.emplace(live->setup.pictures);
    camera.reset();
    window.setTitle(windowTitle(live->setup.scene));
    recent.add(request.file);
}

void Viewer::Inner::open(const std::string& file)
{
    try {
        const SceneRequest other = {.file = file, .variant = "", .sets = {}};
        auto opened = std::make_unique<LivePair>(other, backends);
        pair = std::move(opened);
        request = other;
        livePanel = {};
        scenePanel = {};
        lookAtScene();
    } catch (const sim::InputError& error) {
        scenePanel.message = error.what();
    }
}

void Viewer::Inner::addSecondSide(const std::string& variant)
{
    try {
        if (variant.empty()) pair->removeSecondSide();
        else pair->addSecondSide(withVariant(request, variant), backends);
        showRequested();
        livePanel = {};
        scenePanel.beside = variant;
        camera.reset();
    } catch (const sim::InputError& error) {
        scenePanel.message = error.what();
    }
}

void Viewer::Inner::showRequested()
{
    pair->all([&](LiveSimulation& live) { live.show(lookPanel->wanted()); });
}

void Viewer::Inner::takeNewest()
{
    pair->takeNewest();
    livePanel.take(*pair);
    probePanel.take(*pair);
    const auto& shown = pair->sides().front()->shown;
    if (!shown || camera || window.height() == 0 || widthOfSide() == 0) return;
    const CameraSettings& settings = pair->first().scene()->setup.pictures.render.camera;
    camera.emplace(cameraAt(settings, shown->time, render::bounds(shown->view()), aspect()));
}

void Viewer::Inner::frameAll()
{
    const auto& shown = pair->sides().front()->shown;
    if (shown && camera) camera->frame(render::bounds(shown->view()), aspect());
}

void Viewer::Inner::moveCamera()
{
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse || !camera || io.DisplaySize.y <= 0.0f) return;
    const double right = io.MouseDelta.x / io.DisplaySize.y, up = -io.MouseDelta.y / io.DisplaySize.y;
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0.0f)) camera->orbit(right, up);
    if (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0.0f) || ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0.0f)) camera->pan(right, up);
    if (io.MouseWheel != 0.0f) camera->zoom(io.MouseWheel);
}

/// Side by side, by one camera and with one range of colours.
void Viewer::Inner::drawScenes()
{
    if (!isShowing()) return;
    const auto begin = std::chrono::steady_clock::now();
    const bool isKept = scenePanel.isRecording || !pictureFile.empty();
    const bool isFast = !isKept && isChanging() && fullSeconds > kLongestWait;  // with edges that are not smooth
    render::Viewport part = {.x = widthOfPanels(), .y = 0, .width = widthOfSide(), .height = window.height()};
    for (const auto& side : pair->sides()) {
        if (!side->shown) continue;
        render::Look look = lookPanel->lookFor(*side->shown);
        if (pair->sides().size() > 1) look.overlay.label = labelOf(side->live.scene()->setup);
        look.overlay.colorBar = look.overlay.colorBar && side == pair->sides().back();  // one for both
        if (isFast) look.samples = 1;
        renderer.show(side->shown->view(), camera->camera(), look, part);
        part.x += part.width;
    }
    if (!isFast) fullSeconds = secondsSince(begin);
}

/// Is the next picture likely to be another one?
bool Viewer::Inner::isChanging() const
{
    const auto isPlaying = [](const auto& side) { return side->live.status().mode == LiveMode::Playing; };
    return ImGui::IsAnyMouseDown() || std::ranges::any_of(pair->sides(), isPlaying);
}

Viewer::Viewer(const SceneRequest& request, const Backends& backends, const ViewOptions& options)
    : inner_(std::make_unique<Inner>(request, backends, options))
{
}

Viewer::~Viewer() = default;

bool Viewer::frame()
{
    Inner& in = *inner_;
    const bool goesOn = in.window.begin();
    for (const std::string& file : in.window.dropped()) in.open(file);
    in.takeNewest();
    in.moveCamera();
    in.followKeys();
    in.drawScenes();
    in.writePictures();
    in.drawPanels();
    in.window.drawPanels();
    if (!in.screenshotFile.empty()) in.writeTo(std::exchange(in.screenshotFile, {}));
    in.window.present();
    return goesOn;
}

LivePair& Viewer::pair() { return *inner_->pair; }

void Viewer::open(const std::string& file) { inner_->open(file); }

void Viewer::record(bool isOn) { inner_->record(isOn); }

void Viewer::screenshot(const std::filesystem::path& file) { inner_->screenshotFile = file; }

std::optional<std::array<float, 2>> Viewer::placeOf(const std::string& setting) const { return inner_->parameterPanel.placeOf(setting); }

std::string Viewer::message() const { return inner_->scenePanel.message; }

std::vector<std::string> Viewer::takeGlMessages() { return inner_->window.context().takeGlMessages(); }

void view(const SceneRequest& request, const Backends& backends, const ViewOptions& options)
{
    Viewer viewer(request, backends, options);
    while (viewer.frame() && interruptsSeen() == 0) {
    }
}

}  // namespace app
