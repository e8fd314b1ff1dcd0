#include "app/export/geometry_sink.h"

#include "app/export/geometry_files.h"

namespace app {

GeometrySink::GeometrySink(const SceneSetup& setup, const Parts& parts, const std::filesystem::path& runFolder)
    : density_(setup.scene.settings.liquid.density)
{
    const OutputSettings& output = setup.pictures.output;
    if (!output.geometry) return;
    placeObstacles_ = parts.meshObstacles(setup);
    exporter_.emplace(geometryFolder(runFolder), output.geometryFormats, output.every);
}

void GeometrySink::take(const sim::State& state, const sim::Fabric& fabric, std::int64_t frame)
{
    if (!exporter_) return;
    placeObstacles_(state.time, obstacles_);
    exporter_->write(exportFrame(frame, state, fabric, density_, obstacles_));
}

}  // namespace app
