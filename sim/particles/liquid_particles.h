#pragma once

#include "sim/particles/particles.h"

namespace sim {

/// Bulk liquid. The volume of a particle is its mass over the liquid's density; ids are unique over the run, in the order of emission.
struct LiquidParticles : Particles {};

}  // namespace sim
