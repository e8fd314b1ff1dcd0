#include "app/export/geometry_sink.h"

#include "app/export/geometry_files.h"
#include "app/system/atomic_files.h"

#include <utility>

namespace app {

GeometrySink::GeometrySink(const LoadedScene& setup, const Backends& backends, const std::filesystem::path& runFolder, const std::string& provenance)
    : density_(setup.scene.settings.liquid.density)
{
    const OutputSettings& output = setup.pictures.output;
    if (!output.geometry) return;
    if (output.geometrySurface) surface_.emplace();
    placeObstacles_ = backends.meshObstacles(setup);
    std::vector<FrameTime> earlier;  // of a run that is gone on with
    for (const std::int64_t frame : geometryFrames(runFolder)) earlier.push_back({frame, frameTime(setup, frame)});
    exporter_.emplace(geometryFolder(runFolder), output.geometryFormats, output.every, std::move(earlier));
    writeWhole(geometryFolder(runFolder) / kGeometryProvenance, provenance + '\n');
}

void GeometrySink::take(const sim::State& state, const sim::Fabric& fabric, std::int64_t frame)
{
    if (!exporter_) return;
    placeObstacles_(state.time, obstacles_);
    const sim::SurfaceMesh* surface = surface_ ? &surface_->find(state.liquid, density_) : nullptr;
    exporter_->write(exportFrame(frame, state, fabric, density_, obstacles_, surface));
}

}  // namespace app
