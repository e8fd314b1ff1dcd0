#include "app/frames/snapshot_from_state.h"

#include "app/frames/sample_pressure.h"
#include "app/frames/snapshot_fabric.h"
#include "app/frames/snapshot_lines.h"
#include "app/frames/snapshot_surface.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <cmath>

namespace app {

namespace {

/// Radius of a ball of the particles' mean volume [cm]; 0 without particles.
float meanRadius(const sim::LiquidParticles& liquid, double density)
{
    if (liquid.count == 0) return 0.0f;
    const double mass = sim::parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p]; });
    const double volume = mass / density / static_cast<double>(liquid.count);
    return static_cast<float>(std::cbrt(0.75 / sim::kPi * volume));
}

}  // namespace

SnapshotExtras extrasOf(const RenderSettings& settings)
{
    return {.pressure = settings.colorBy == ColorBy::Pressure,
            .yarns = settings.yarns.colorBy,
            .cloth = settings.cloth.colorBy,
            .surface = settings.liquidStyle == LiquidStyle::Surface};
}

void fillSnapshot(const sim::State& state, const sim::Fabric& fabric, const sim::ActiveContacts* contacts, double density,
                  const SnapshotExtras& extras, FrameSnapshot& snapshot)
{
    const sim::LiquidParticles& liquid = state.liquid;
    snapshot.time = state.time;
    snapshot.radius = meanRadius(liquid, density);
    snapshot.positions.resize(liquid.count);
    snapshot.values.resize(liquid.count);
    constexpr std::size_t kGrain = 4096;
    sim::parallelFor(liquid.count, kGrain, [&](std::size_t p) {
        const sim::Vec3 x = liquid.position(p);
        snapshot.positions[p] = x.cast<float>();
        snapshot.values[p] = static_cast<float>(extras.pressure ? smoothPressure(state, x) : liquid.velocity(p).norm());
    });
    takeSurface(state, density, extras, snapshot.surface);
    takeYarns(fabric, state.fabric, density, extras.yarns, snapshot.yarns);
    takeCloth(fabric, state.fabric, density, extras.cloth, snapshot.cloth);
    takeLines(state, fabric, contacts, extras, snapshot.radius, snapshot.lines);
    snapshot.extras = extras;
}

}  // namespace app
