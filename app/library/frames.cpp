#include "drench/frames.h"

#include "app/drawing/look_from_settings.h"
#include "app/drawing/obstacle_meshes.h"
#include "app/frames/snapshot_from_state.h"
#include "app/library/convert_errors.h"
#include "app/library/scene_parts.h"
#include "app/library/simulation_parts.h"
#include "app/scene/read_picture_settings.h"
#include "render/renderer.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>

namespace drench {

namespace {

/// Runs body(), errors of which become Error: those that convertErrors converts, and what the renderer and the system throw.
template <class Body>
decltype(auto) convertFailures(Body&& body)
{
    try {
        return convertErrors(body);
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& error) {
        throw Error(error.what());
    }
}

}  // namespace

/// What draws, and what it keeps from picture to picture.
struct Frames::Parts {
    Parts(const sim::SceneFile& file, const sim::Scene& scene, const std::string& shaders)
        : pictures(app::readPictureSettings(file)),
          density(scene.settings.liquid.density),
          placeObstacles(app::meshObstacles(scene)),
          context(render::makeOsMesaContext()),
          renderer(*context, shaders)
    {
        pictures.contents = app::contentsOf(scene);
    }

    render::Image draw(const app::RealSimulation& simulation);

    app::PictureSettings pictures;
    double density;  ///< density of the liquid [g/cm^3]
    app::PlaceObstacles placeObstacles;
    std::unique_ptr<render::GlContext> context;
    render::Renderer renderer;
    app::FrameSnapshot snapshot;
    std::optional<Eigen::AlignedBox3d> everything;  ///< box around everything in the first picture [cm]
};

render::Image Frames::Parts::draw(const app::RealSimulation& simulation)
{
    const sim::State& state = simulation.state();
    app::fillSnapshot(state, simulation.fabric(), simulation.contacts(), density, app::extrasOf(pictures.render), snapshot);
    placeObstacles(state.time, snapshot.obstacles);
    const render::FrameView view = snapshot.view();
    if (!everything) everything = render::bounds(view);
    const render::Look look = app::lookOf(pictures, "", false);
    const double aspect = static_cast<double>(look.width) / look.height;
    return renderer.draw(view, app::cameraAt(pictures.render.camera, state.time, *everything, aspect), look);
}

Frames::Frames(const Scene& scene, const std::string& shaders)
{
    parts_ = convertFailures([&] { return std::make_unique<Parts>(scene.parts().file, scene.parts().read(), shaders); });
}

Frames::Frames(Frames&&) noexcept = default;
Frames& Frames::operator=(Frames&&) noexcept = default;
Frames::~Frames() = default;

Picture Frames::draw(const Simulation& simulation)
{
    render::Image image = convertFailures([&] { return parts_->draw(simulation.parts().real()); });
    return {.width = image.width, .height = image.height, .rgb = std::move(image.pixels)};
}

void Frames::write(const Simulation& simulation, const std::string& file)
{
    convertFailures([&] {
        const std::filesystem::path folder = std::filesystem::path(file).parent_path();
        if (!folder.empty()) std::filesystem::create_directories(folder);
        const render::Image image = parts_->draw(simulation.parts().real());
        render::writePng(image, file,
                         {{"Software", "Drench " DRENCH_VERSION},
                          {"Time", fmt::format("{:.9g} s", simulation.time())},
                          {"State hash", fmt::format("{:016x}", simulation.stateHash())}});
    });
}

std::string frameFile(const std::string& folder, int number) { return fmt::format("{}/frame_{:05d}.png", folder, number); }

}  // namespace drench
