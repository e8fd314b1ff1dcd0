#pragma once

#include "sim/core/check.h"
#include "sim/fabric/fabric.h"
#include "sim/particles/particle_order.h"
#include "sim/state.h"

namespace sim {

/// In builds with checks: liquid and fabric together keep their momentum over a stage, but for what pins hold back (model-fluid 9.4).
class MomentumWatch {
 public:
    /// @param order  of particles whose masses are sorted already and whose modes are not; else null
    MomentumWatch(const Fabric& fabric, const State& state, const ParticleOrder* order) : fabric_(fabric), state_(state), order_(order)
    {
#ifdef DRENCH_CHECKS
        before_ = measure();
#endif
    }
    /// @param toPins  [g cm/s]
    void expectKept([[maybe_unused]] const Vec3& toPins) const
    {
#ifdef DRENCH_CHECKS
        const Momentum after = measure();
        SIM_CHECK((before_.sum - after.sum - toPins).norm() <= 1.0e-12 * before_.size);
#endif
    }

 private:
    struct Momentum {
        Vec3 sum = Vec3::Zero();
        double size = 0.0;  ///< Σ m |v|
    };
    Momentum measure() const
    {
        Momentum momentum;
        const auto add = [&](double mass, const Vec3& v) {
            momentum.sum += mass * v;
            momentum.size += mass * v.norm();
        };
        const LiquidParticles& liquid = state_.liquid;
        for (std::size_t p = 0; p < liquid.count; ++p) add(liquid.mass[p], liquid.velocity(order_ ? order_->source[p] : p));
        for (std::size_t v = 0; v < fabric_.vertexCount(); ++v) add(fabric_.mass[v] + state_.fabric.absorbed[v], state_.fabric.v[v]);
        return momentum;
    }

    const Fabric& fabric_;
    const State& state_;
    const ParticleOrder* order_;
    Momentum before_;
};

}  // namespace sim
