#pragma once

#include "sim/core/types.h"

#include <vector>

namespace sim {

/// What liquid does to each vertex in a step, with the liquid's velocity solved for (model-fabric 13.6): M (v − v*) = impulse − drag v
/// beside the fabric's own forces, by components.
struct LiquidLoads {
    std::vector<Vec3> drag;     ///< Σ D' of the faces around; 0 where there is no liquid [g]
    std::vector<Vec3> impulse;  ///< Σ D' ũ of the liquid and of its pressure [g cm/s]
};

}  // namespace sim
