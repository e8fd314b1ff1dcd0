#include "app/frame_view_from_state.h"

#include "app/fabric_in_frame.h"
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

void takeSnapshot(const sim::State& state, const sim::Fabric& fabric, double density, const RenderSettings& look, FrameSnapshot& snapshot)
{
    const sim::LiquidParticles& liquid = state.liquid;
    snapshot.time = state.time;
    snapshot.radius = meanRadius(liquid, density);
    snapshot.positions.resize(liquid.count);
    snapshot.speeds.resize(liquid.count);
    constexpr std::size_t kGrain = 4096;
    sim::parallelFor(liquid.count, kGrain, [&](std::size_t p) {
        snapshot.positions[p] = liquid.position(p).cast<float>();
        snapshot.speeds[p] = static_cast<float>(liquid.velocity(p).norm());
    });
    takeYarns(fabric, state.fabric, density, look.yarns.colorBy, snapshot.yarns);
    takeCloth(fabric, state.fabric, density, look.cloth.colorBy, snapshot.cloth);
}

}  // namespace app
