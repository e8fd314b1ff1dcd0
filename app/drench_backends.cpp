#include "app/backends.h"
#include "app/drawing/obstacle_meshes.h"
#include "app/drawing/offscreen_renderer.h"
#include "app/lab/precision/precision.h"
#include "app/lab/validation/validation.h"
#include "app/probes/probes.h"
#include "app/real_simulation.h"
#include "app/scene/read_picture_settings.h"
#include "app/scene/unread_pictures.h"
#include "app/view/viewer.h"
#include "sim/scene/load_scene.h"

#include <algorithm>

namespace app {

namespace {

/// Sections that are read where they are needed: mistakes in them are told with all others.
void requireReadable(const LoadedScene& setup)
{
    readValidation(setup);
    readPrecision(setup);
    readProbes(setup);
}

LoadedScene loadScene(const SceneRequest& request)
{
    const sim::LoadOptions options = {.variant = request.variant, .set = request.sets};
    LoadedScene setup;
    setup.request = request;
    setup.file = request.text ? sim::sceneFileFromText(*request.text, request.file, options) : sim::loadSceneFile(request.file, options);
    const sim::SceneFile& file = setup.file;
    setup.scene = sim::readScene(file);
    setup.pictures = readPictureSettings(file);
    setup.pictures.contents = contentsOf(setup.scene);
    for (const std::string& note : unreadPictureNotes(file.root, setup.pictures)) setup.scene.notes.push_back(note);
    requireReadable(setup);
    const auto variant = std::ranges::find(setup.pictures.compare.variants, request.variant, &Variant::name);
    if (variant != setup.pictures.compare.variants.end()) {
        setup.variant = variant->name;
        setup.label = variant->label;
    }
    const std::string scene = sim::printScene(setup.scene);
    setup.resolved = scene + printPictureSettings(setup.pictures);
    for (const std::string key : {"validate", "precision"})
        if (const sim::Node* node = file.root.find(key)) setup.resolved += key + ": " + node->flow() + '\n';
    PictureSettings alone = setup.pictures;
    alone.compare = {};
    setup.identity = scene + printPictureSettings(alone);
    return setup;
}

}  // namespace

Backends drenchBackends()
{
    return {
        .loadScene = loadScene,
        .startSimulation = [](const LoadedScene& setup) { return std::make_unique<RealSimulation>(setup.scene); },
        .resumeSimulation = [](const LoadedScene& setup, const sim::State& state) { return std::make_unique<RealSimulation>(setup.scene, state); },
        .meshObstacles = [](const LoadedScene& setup) { return meshObstacles(setup.scene); },
        .startRenderer = startOffscreenRenderer,
        .drawnBy = offscreenRendererName,
        .putSideBySide = putSideBySide,
        .writePng = writeRgbPng,
#ifdef DRENCH_WINDOWS
        .view = view};
#else
        .view = nullptr};
#endif
}

}  // namespace app
