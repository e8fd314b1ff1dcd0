#include "sim/sources/fill_up.h"

#include "sim/core/check.h"
#include "sim/sources/lay.h"

namespace sim {

void fillUp(const Scene& scene, std::size_t source, const Emission& emission, double time, State& state)
{
    const SeedPlan plan = planFor(scene, source, time, state);
    const Seeds seeds = seedsFor(scene, source, plan, liquidNear(state.liquid, plan, scene.settings.liquid.density));
    if (seeds.positions.empty()) {
        if (!isInstant(emission)) return;
        throw InputError(nameOf(scene, source) + "has no room for a particle: it is empty, smaller than " +
                         std::to_string(particleSpacing(plan.fill, plan.dx)) + " cm, inside an obstacle, or full already");
    }
    const double most = emission.maxVolume - state.emittedVolume[source];
    if (seeds.volumes.empty()) {
        lay(scene, source, emission, firstOf(seeds, countUpTo(most, seeds.volume)), state);
        return;
    }
    std::size_t count = 0;
    for (double volume = 0.0; count < seeds.volumes.size() && volume < most; ++count) volume += seeds.volumes[count];
    lay(scene, source, emission, firstOf(seeds, count), state);
}

}  // namespace sim
