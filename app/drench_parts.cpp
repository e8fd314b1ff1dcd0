#include "app/drawing/obstacle_meshes.h"
#include "app/drawing/offscreen_renderer.h"
#include "app/lab/precision/precision.h"
#include "app/lab/validation/validation.h"
#include "app/parts.h"
#include "app/probes/probes.h"
#include "app/scene/read_picture_settings.h"
#include "app/scene/unread_pictures.h"
#include "app/view/viewer.h"
#include "sim/scene/load_scene.h"
#include "sim/simulation.h"

#include <algorithm>

namespace app {

namespace {

SceneContents contentsOf(const sim::Scene& scene)
{
    SceneContents contents;
    for (const sim::FabricPiece& piece : scene.fabrics) {
        contents.yarns = contents.yarns || !piece.strands.empty();
        contents.cloth = contents.cloth || !piece.faces.empty();
    }
    contents.liquid = !scene.sources.empty() || !contents.fabric();
    contents.obstacles = !scene.obstacles.empty();
    contents.rooms = std::ranges::any_of(scene.obstacles, &sim::ObstacleSettings::inside);
    return contents;
}

/// Sections that are read where they are needed: mistakes in them are told with all others.
void requireReadable(const SceneSetup& setup)
{
    readValidation(setup);
    readPrecision(setup);
    readProbes(setup);
}

SceneSetup loadScene(const SceneRequest& request)
{
    const sim::LoadOptions options = {.variant = request.variant, .set = request.sets};
    SceneSetup setup;
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

class RealSimulation : public Steppable {
 public:
    explicit RealSimulation(const sim::Scene& scene) : simulation_(scene) {}
    RealSimulation(const sim::Scene& scene, const sim::State& state) : simulation_(scene, state) {}
    const sim::State& state() const override { return simulation_.state(); }
    const sim::Fabric& fabric() const override { return simulation_.fabric(); }
    const sim::ActiveContacts* contacts() const override
    {
        const auto& fabric = simulation_.workspace().fabric;
        return fabric ? fabric->contacts() : nullptr;
    }
    const sim::LiquidGrid& liquidGrid() const override { return simulation_.workspace().grid; }
    const sim::Forces& forces() const override { return simulation_.forces(); }
    sim::StepReport step(double until) override { return simulation_.step(until); }
    sim::Energies energies() const override { return simulation_.energies(); }
    void bookEnergy() override { simulation_.bookEnergy(); }
    std::uint64_t stateHash() const override { return sim::stateHash(simulation_.state()); }
    void setChanges(std::vector<sim::SettingsChange> changes) override { simulation_.setChanges(std::move(changes)); }

 private:
    sim::Simulation simulation_;
};

}  // namespace

Parts drenchParts()
{
    return {.loadScene = loadScene,
            .startSimulation = [](const SceneSetup& setup) { return std::make_unique<RealSimulation>(setup.scene); },
            .resumeSimulation = [](const SceneSetup& setup, const sim::State& state) { return std::make_unique<RealSimulation>(setup.scene, state); },
            .meshObstacles = [](const SceneSetup& setup) { return meshObstacles(setup.scene); },
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
