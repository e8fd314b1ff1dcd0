#pragma once

#include "sim/scene/scene.h"
#include "sim/state.h"

namespace sim {

/// Lays particles where a source has room for them at a time [s]: a body that is laid once, or liquid at rest that fills its source up again as it
/// leaves. Throws InputError where a body has no room for a particle.
void fillUp(const Scene& scene, std::size_t source, const Emission& emission, double time, State& state);

}  // namespace sim
