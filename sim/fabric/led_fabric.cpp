#include "sim/fabric/led_fabric.h"

#include "sim/core/parallel.h"
#include "sim/fabric/pins.h"

#include <algorithm>

namespace sim {

LedFabric::LedFabric(const Fabric& fabric, const FabricSettings& settings)
    : fabric_(fabric), rods_(fabric, restState(fabric), settings), restReference_(restState(fabric).reference)
{
}

FabricReport LedFabric::advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock&, const FabricLoads& loads)
{
    FabricReport report;
    if (booksEnergy_) before_ = state.v;
    const std::vector<Vec3> targets = pinTargets(fabric_, t + h);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        state.v[v] = (targets[i] - state.x[v]) / h;
        state.x[v] = targets[i];
    }
    if (std::ranges::any_of(fabric_.pins.motions, [&](const Motion& motion) { return motion.moves(t, t + h); })) {
        rods_.transportFrames(state);
        for (std::size_t e = 0; e < fabric_.edges.size(); ++e)
            if (fabric_.edges.twistHeld[e]) state.theta[e] = heldAngle(fabric_, restReference_, t + h, state, static_cast<int>(e));
    }
    if (booksEnergy_) report.energyChanges = changes(h, gravity, state, loads.onVertices);
    return report;
}

/// All vertices are held: what holds them takes the liquid's impulse and gives them their motion.
EnergyChanges LedFabric::changes(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const
{
    EnergyChanges sum;
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const double mass = fabric_.mass[v] + state.absorbed[v];
        const Vec3 faster = state.v[v] - before_[v];
        const Vec3 byLiquid = loads ? Vec3(loads->impulse[v] - loads->drag[v].cwiseProduct(state.v[v])) : Vec3::Zero().eval();
        sum[EnergyChange::Drag] += byLiquid.dot(state.v[v]);
        sum[EnergyChange::Implicit] -= 0.5 * mass * faster.squaredNorm();
        sum[EnergyChange::Pins] += (mass * (faster - h * gravity) - byLiquid).dot(state.v[v]);
    }
    return sum;
}

}  // namespace sim
