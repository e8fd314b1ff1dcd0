#include "app/view/viewer.h"

#include "app/drawing/look_from_settings.h"
#include "app/system/atomic_files.h"
#include "app/system/interrupt.h"
#include "app/system/stopwatch.h"
#include "app/view/live_panel.h"
#include "app/view/look_panel.h"
#include "app/view/parameter_panel.h"
#include "app/view/probe_panel.h"
#include "app/view/saved_scene.h"
#include "app/view/scene_panel.h"
#include "app/view/view_camera.h"
#include "app/view/window.h"
#include "render/draw_targets.h"
#include "render/renderer.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <optional>

namespace app {

namespace {

constexpr double kLongestWait = 0.1;  ///< for a picture of full quality while something changes [s]
constexpr float kPanelWidth = 24.0f;  ///< of the column with the panels [font sizes]

std::string titleOf(const sim::Scene& scene) { return fmt::format("{} - Drench", scene.title.empty() ? scene.name : scene.title); }

std::string labelOf(const SceneSetup& setup) { return setup.label.empty() ? "as written" : setup.label; }

SceneRequest withVariant(SceneRequest request, const std::string& variant)
{
    if (!variant.empty()) request.variant = variant;
    return request;
}

}  // namespace

struct Viewer::Inner {
    Inner(const SceneRequest& asked, const Parts& p, const ViewOptions& options)
        : parts(p),
          request(asked),
          pair(std::make_unique<LivePair>(request, parts)),
          window(titleOf(scene()), options.width, options.height),
          renderer(window.context())
    {
        lookAtScene();
        if (!options.beside.empty()) putBeside(options.beside);
        if (!options.paused) pair->playOrPause();
    }

    const Parts parts;
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
    std::size_t tuned = 0;                              ///< the side whose settings are shown
    std::optional<ViewCamera> camera;                   ///< once there is something to look at
    std::filesystem::path screenshotFile, pictureFile;  ///< of the next frame, with and without panels; or empty
    std::filesystem::path recordFolder;                 ///< of recorded frames
    std::int64_t recorded = -1;                         ///< number of the last one
    double fullSeconds = 0.0;                           ///< that the last picture of full quality took

    const sim::Scene& scene() const { return pair->first().scene()->setup.scene; }
    LivePair::Side& tunedSide() { return *pair->sides()[std::min(tuned, pair->sides().size() - 1)]; }
    int widthOfPanels() const;
    int widthOfSide() const { return (window.width() - widthOfPanels()) / static_cast<int>(pair->sides().size()); }
    double aspect() const { return static_cast<double>(widthOfSide()) / window.height(); }
    bool isShowing() const { return camera && widthOfSide() > 0 && window.height() > 0; }

    void lookAtScene();
    void open(const std::string& file);
    void putBeside(const std::string& variant);
    void showWhatIsWanted();
    void takeNewest();
    void moveCamera();
    void followKeys();
    void followKey(int key);
    void followControl(int key);
    void frameAll();
    void drawScenes();
    bool isChanging() const;
    void drawPanels();
    void drawPicturePanel();
    void drawSettings();
    void follow(const SceneCommands& commands);
    void record(bool isOn);
    void save();
    void writePictures();
    void writeTo(const std::filesystem::path& file);
};

/// The window begins with what the scene's file says of its pictures.
void Viewer::Inner::lookAtScene()
{
    const auto live = pair->first().scene();
    lookPanel.emplace(live->setup.pictures);
    camera.reset();
    window.setTitle(titleOf(live->setup.scene));
    recent.add(request.file);
}

void Viewer::Inner::open(const std::string& file)
{
    try {
        const SceneRequest other = {.file = file, .variant = "", .sets = {}};
        auto opened = std::make_unique<LivePair>(other, parts);
        pair = std::move(opened);
        request = other;
        livePanel = {};
        scenePanel = {};
        lookAtScene();
    } catch (const sim::InputError& error) {
        scenePanel.message = error.what();
    }
}

void Viewer::Inner::putBeside(const std::string& variant)
{
    try {
        if (variant.empty()) pair->removeBeside();
        else pair->putBeside(withVariant(request, variant), parts);
        showWhatIsWanted();
        livePanel = {};
        scenePanel.beside = variant;
        camera.reset();
    } catch (const sim::InputError& error) {
        scenePanel.message = error.what();
    }
}

void Viewer::Inner::showWhatIsWanted()
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

void Viewer::Inner::followKeys()
{
    if (ImGui::GetIO().WantCaptureKeyboard) return;
    for (const Window::Key& key : window.keys()) {
        if (key.isControl) followControl(key.code);
        else followKey(key.code);
    }
}

void Viewer::Inner::followKey(int key)
{
    if (key == ' ') pair->playOrPause();
    if (key == 'S') pair->all([](LiveSimulation& live) { live.stepOnce(); });
    if (key == 'R') pair->all([](LiveSimulation& live) { live.restart(); });
    if (key == 'F') frameAll();
    if (key == 'C') camera.reset();
    if (key == 'P') follow({.picture = true});
}

void Viewer::Inner::followControl(int key)
{
    if (key == 'S') follow({.save = true});
    if (key == 'C') follow({.copyCommand = true});
    if (key == 'Q') window.close();
}

/// That two scenes leave to the panels [pixels]; one is drawn behind them.
int Viewer::Inner::widthOfPanels() const
{
    const int width = static_cast<int>(kPanelWidth * ImGui::GetFontSize());
    return pair->sides().size() > 1 && window.width() > 2 * width ? width : 0;
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

void Viewer::Inner::drawPanels()
{
    const float unit = ImGui::GetFontSize(), height = ImGui::GetIO().DisplaySize.y;
    const float width = std::min((kPanelWidth - 0.8f) * unit, 0.9f * ImGui::GetIO().DisplaySize.x);
    ImGui::SetNextWindowPos(ImVec2(0.4f * unit, 0.4f * unit), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.48f * height), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Simulation")) {
        livePanel.draw(*pair);
        if (ImGui::CollapsingHeader("Picture")) drawPicturePanel();
        if (ImGui::CollapsingHeader("Scene")) follow(scenePanel.draw(*pair->first().scene(), recent));
    }
    ImGui::End();
    ImGui::SetNextWindowPos(ImVec2(0.4f * unit, 0.5f * height), ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(ImVec2(width, 0.48f * height), ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Settings")) drawSettings();
    ImGui::End();
    probePanel.draw(*pair);
}

void Viewer::Inner::drawPicturePanel()
{
    if (ImGui::Button("Show all")) frameAll();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("F");
    ImGui::SameLine();
    if (ImGui::Button("Camera of the file")) camera.reset();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("C");
    if (lookPanel->draw()) showWhatIsWanted();
}

void Viewer::Inner::drawSettings()
{
    if (pair->sides().size() > 1) {
        int side = static_cast<int>(tuned);
        ImGui::RadioButton("A", &side, 0);
        ImGui::SameLine();
        ImGui::RadioButton("B", &side, 1);
        tuned = static_cast<std::size_t>(side);
    }
    parameterPanel.draw(tunedSide().live);
}

void Viewer::Inner::follow(const SceneCommands& commands)
{
    if (commands.save) save();
    if (commands.copyCommand) {
        ImGui::SetClipboardText(commandLine(tunedSide().live.scene()->request).c_str());
        scenePanel.message = "copied";
    }
    if (commands.picture) pictureFile = freeName(scene().name, ".png");
    if (commands.record) record(*commands.record);
    if (commands.beside) putBeside(*commands.beside);
    if (commands.open) open(*commands.open);  // last: the scene is another one then
}

void Viewer::Inner::record(bool isOn)
{
    scenePanel.isRecording = isOn;
    pair->showEveryFrame(isOn);
    if (!isOn) return;
    recordFolder = freeName(scene().name + "_frames", "");
    recorded = -1;
    scenePanel.message = "frames go to " + recordFolder.string();
}

void Viewer::Inner::save()
{
    if (!camera) return;
    const auto live = tunedSide().live.scene();
    const std::filesystem::path file = freeName(live->setup.scene.name + "_live", ".yaml");
    try {
        writeWhole(file, savedScene(*live, camera->camera()));
        scenePanel.message = "saved as " + file.string();
    } catch (const std::runtime_error& error) {
        scenePanel.message = error.what();
    }
}

void Viewer::Inner::writeTo(const std::filesystem::path& file)
{
    try {
        std::filesystem::create_directories(std::filesystem::absolute(file).parent_path());
        render::writePng(render::readFramebuffer(window.context().gl(), 0, window.width(), window.height()), file);
    } catch (const std::exception& error) {
        scenePanel.message = error.what();
        if (scenePanel.isRecording) record(false);
    }
}

/// Of the scenes alone: before the panels are drawn over them.
void Viewer::Inner::writePictures()
{
    if (!isShowing()) return;
    if (!pictureFile.empty()) {
        scenePanel.message = "picture in " + pictureFile.string();
        writeTo(std::exchange(pictureFile, {}));
    }
    const auto& shown = pair->sides().front()->shown;
    if (!scenePanel.isRecording || !shown || shown->number == recorded) return;
    recorded = shown->number;
    writeTo(recordFolder / fmt::format("frame_{:05}.png", recorded));
}

Viewer::Viewer(const SceneRequest& request, const Parts& parts, const ViewOptions& options) : inner_(std::make_unique<Inner>(request, parts, options))
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

void view(const SceneRequest& request, const Parts& parts, const ViewOptions& options)
{
    Viewer viewer(request, parts, options);
    while (viewer.frame() && interruptsSeen() == 0) {
    }
}

}  // namespace app
