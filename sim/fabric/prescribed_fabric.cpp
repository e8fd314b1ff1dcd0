#include "sim/fabric/prescribed_fabric.h"

#include "sim/core/parallel.h"
#include "sim/fabric/pins.h"
#include "sim/forces.h"

#include <algorithm>

namespace sim {

PrescribedFabric::PrescribedFabric(const Fabric& fabric, const FabricSettings& settings)
    : fabric_(fabric), rods_(fabric, restState(fabric), settings), restReference_(restState(fabric).reference)
{
}

FabricReport PrescribedFabric::advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock&, const FabricLoads& loads)
{
    FabricReport report;
    if (booksEnergy_ || forces_) before_ = state.v;
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
    if (forces_) reportForces(h, gravity, state, loads.onVertices);
    if (booksEnergy_) report.energyChanges = changes(h, gravity, state, loads.onVertices);
    return report;
}

Vec3 PrescribedFabric::byLiquid(const LiquidLoads* loads, const FabricState& state, std::size_t v)
{
    return loads ? Vec3(loads->impulse[v] - loads->drag[v].cwiseProduct(state.v[v])) : Vec3::Zero().eval();
}

Vec3 PrescribedFabric::reaction(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads, std::size_t v) const
{
    const double mass = fabric_.mass[v] + state.absorbed[v];
    return mass * (state.v[v] - before_[v] - h * gravity) - byLiquid(loads, state, v);
}

/// All vertices are held: what holds them takes the liquid's impulse and gives them their motion.
EnergyChanges PrescribedFabric::changes(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const
{
    EnergyChanges sum;
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const double mass = fabric_.mass[v] + state.absorbed[v];
        sum[EnergyChange::Drag] += byLiquid(loads, state, v).dot(state.v[v]);
        sum[EnergyChange::Implicit] -= 0.5 * mass * (state.v[v] - before_[v]).squaredNorm();
        sum[EnergyChange::Pins] += reaction(h, gravity, state, loads, v).dot(state.v[v]);
    }
    return sum;
}

/// Pins hold their own vertices; what holds the others is nothing of the scene.
void PrescribedFabric::reportForces(double h, const Vec3& gravity, const FabricState& state, const LiquidLoads* loads) const
{
    if (loads)
        for (std::size_t v = 0; v < state.v.size(); ++v)
            forces_->fabrics[fabric_.pieceOf(static_cast<int>(v))].liquid += Impulse::at(state.x[v], byLiquid(loads, state, v));
    for (std::size_t i = 0; i < fabric_.pins.vertex.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        forces_->pins[fabric_.pins.motion[i]] -= Impulse::at(state.x[v], reaction(h, gravity, state, loads, v));
    }
}

}  // namespace sim
