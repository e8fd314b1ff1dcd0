#pragma once

#include "sim/fabric/fabric.h"

#include <vector>

namespace sim {

/// Water that fabric takes up comes without spin: yarns keep their momentum of twist, J ω, and turn more slowly.
class TwistMomentum {
 public:
    /// Calls absorb(), by which the fabric takes up water, and turns the yarns by what they weigh then.
    template <class Absorb>
    void keep(const Fabric& fabric, FabricState& state, Absorb&& absorb)
    {
        before_.resize(fabric.edges.size());
        for (std::size_t e = 0; e < before_.size(); ++e) before_[e] = twistInertia(fabric, state.absorbed, e);
        absorb();
        for (std::size_t e = 0; e < before_.size(); ++e)
            if (!fabric.edges.twistHeld[e]) state.omega[e] *= before_[e] / twistInertia(fabric, state.absorbed, e);
    }

 private:
    std::vector<double> before_;  ///< inertia of each yarn edge [g cm^2]
};

}  // namespace sim
