#include "app/frames/snapshot_surface.h"

#include "app/frames/sample_pressure.h"
#include "sim/core/parallel.h"
#include "sim/surface/liquid_surface.h"

namespace app {

void takeSurface(const sim::State& state, double density, const SnapshotExtras& extras, FrameSnapshot::Surface& out)
{
    out = {};
    if (!extras.surface) return;
    sim::LiquidSurface surface;
    const sim::SurfaceMesh& mesh = surface.find(state.liquid, density, {.hasVelocities = !extras.pressure});
    const std::size_t count = mesh.positions.size();
    out.positions.resize(count);
    out.normals.resize(count);
    out.values.resize(count);
    out.triangles = mesh.triangles;
    constexpr std::size_t kGrain = 4096;
    sim::parallelFor(count, kGrain, [&](std::size_t v) {
        out.positions[v] = mesh.positions[v].cast<float>();
        out.normals[v] = mesh.normals[v].cast<float>();
        out.values[v] = static_cast<float>(extras.pressure ? smoothPressure(state, mesh.positions[v]) : mesh.velocities[v].norm());
    });
}

}  // namespace app
