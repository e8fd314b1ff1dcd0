#pragma once

#include "sim/core/check.h"
#include "sim/fabric/fabric.h"
#include "sim/particles/particle_order.h"
#include "sim/state.h"

#include <cmath>
#include <numeric>
#include <span>

namespace sim {

/// In builds with checks: over a stage of the exchange, liquid and fabric together keep their water, and their momentum
/// but for what pins hold back (coupling/README.md, What is kept).
class ExchangeWatch {
 public:
    /// @param order  of particles whose masses are sorted already and whose modes are not; else null
    ExchangeWatch(const Fabric& fabric, const State& state, const ParticleOrder* order) : fabric_(fabric), state_(state), order_(order)
    {
#ifdef DRENCH_CHECKS
        before_ = measure();
#endif
    }
    /// @param pinImpulse  momentum that pins held back of each vertex [g cm/s]; empty if nothing
    void expectKept([[maybe_unused]] std::span<const Vec3> pinImpulse) const
    {
#ifdef DRENCH_CHECKS
        constexpr double kRoundOff = 1.0e-12;
        const Sums after = measure();
        const Vec3 heldBack = std::accumulate(pinImpulse.begin(), pinImpulse.end(), Vec3::Zero().eval());
        SIM_CHECK(std::abs(before_.water - after.water) <= kRoundOff * before_.water);
        SIM_CHECK((before_.momentum - after.momentum - heldBack).norm() <= kRoundOff * before_.momentumSize);
#endif
    }

 private:
    struct Sums {
        double water = 0.0;            ///< [g]
        Vec3 momentum = Vec3::Zero();  ///< [g cm/s]
        double momentumSize = 0.0;     ///< Σ m |v|
    };
    Sums measure() const
    {
        Sums sums;
        const auto add = [&](double mass, const Vec3& v) {
            sums.momentum += mass * v;
            sums.momentumSize += mass * v.norm();
        };
        const LiquidParticles& liquid = state_.liquid;
        for (std::size_t p = 0; p < liquid.count; ++p) {
            sums.water += liquid.mass[p];
            add(liquid.mass[p], liquid.velocity(order_ ? order_->source[p] : p));
        }
        for (std::size_t v = 0; v < fabric_.vertexCount(); ++v) {
            sums.water += state_.fabric.absorbed[v];
            add(fabric_.mass[v] + state_.fabric.absorbed[v], state_.fabric.v[v]);
        }
        return sums;
    }

    const Fabric& fabric_;
    const State& state_;
    const ParticleOrder* order_;
    Sums before_;
};

}  // namespace sim
