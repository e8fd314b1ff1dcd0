#include "app/pictures/frame_sink.h"

#include "app/frames/snapshot_from_state.h"

#include <utility>

namespace app {

FrameSink::FrameSink(const LoadedScene& setup, const Backends& backends, const std::filesystem::path& folder, bool asPanel, bool fromStart)
    : setup_(setup), placeObstacles_(backends.meshObstacles(setup))
{
    std::shared_ptr<FrameSnapshot> start;
    if (!fromStart && setup.pictures.render.camera.autoFrame) {
        start = std::make_shared<FrameSnapshot>();
        const auto simulation = backends.startSimulation(setup);
        fillIn(simulation->state(), simulation->fabric(), nullptr, *start);
    }
    pipeline_.emplace(
        [&setup, startRenderer = backends.startRenderer, asPanel, start] {
            const DrawFrame draw = startRenderer(setup, asPanel);
            if (start) draw(*start);
            return draw;
        },
        folder);
}

void FrameSink::take(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, std::int64_t frame,
                     std::uint64_t stateHash)
{
    auto snapshot = pipeline_->borrow();
    snapshot->stateHash = stateHash;
    snapshot->number = frame;
    fillIn(state, fabric, contacts, *snapshot);
    pipeline_->submit(std::move(snapshot));
}

void FrameSink::fillIn(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, FrameSnapshot& snapshot) const
{
    fillSnapshot(state, fabric, contacts, setup_.scene.settings.liquid.density, extrasOf(setup_.pictures.render), snapshot);
    placeObstacles_(state.time, snapshot.obstacles);
}

}  // namespace app
