#include "app/system/atomic_files.h"
#include "app/view/saved_scene.h"
#include "app/view/viewer_inner.h"
#include "render/draw_targets.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <imgui.h>

#include <utility>

// What the user wants done, by keys and buttons, and the files that come of it.

namespace app {

void Viewer::Inner::followKeys()
{
    if (!window.keys().empty()) isFirstUse = false;
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

void Viewer::Inner::follow(const SceneCommands& commands)
{
    if (commands.save) save();
    if (commands.copyCommand) {
        ImGui::SetClipboardText(commandLine(tunedSide().live.scene()->request).c_str());
        scenePanel.message = "copied";
    }
    if (commands.picture) pictureFile = freeName(scene().name, ".png");
    if (commands.record) record(*commands.record);
    if (commands.beside) addSecondSide(*commands.beside);
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

/// Writes pictures of the scenes alone, before the panels are drawn over them.
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

}  // namespace app
