#pragma once

#include "sim/core/types.h"

namespace sim {

/// Liquid that has entered and left so far; particles and fabric hold the rest.
struct Ledger {
    double emittedMass = 0.0;          ///< mass that sources brought, and that was in wet fabric at the start [g]
    double leftMass = 0.0;             ///< deleted outside the domain [g]
    Vec3 leftMomentum = Vec3::Zero();  ///< [g cm/s]
};

}  // namespace sim
