#pragma once

#include "app/backends.h"
#include "app/export/exporter.h"
#include "sim/surface/liquid_surface.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace app {

/// Writes the frames of one scene as geometry, below a run's folder, or does nothing where the scene wants none.
class GeometrySink {
 public:
    /// @param provenance  of what it writes, see provenanceOf(); goes into a file beside the geometry
    GeometrySink(const LoadedScene& setup, const Backends& backends, const std::filesystem::path& runFolder, const std::string& provenance);

    /// @param fabric  what state.fabric is the state of
    void take(const sim::State& state, const sim::Fabric& fabric, std::int64_t frame);

 private:
    const double density_;  ///< density of the liquid [g/cm^3]
    PlaceObstacles placeObstacles_;
    std::vector<FrameSnapshot::Mesh> obstacles_;
    std::optional<Exporter> exporter_;
    std::optional<sim::LiquidSurface> surface_;  ///< where the scene wants its mesh
};

}  // namespace app
