#include "sim/coupling/exchange_watch.h"
#include "sim/stages/stages.h"

namespace sim {

namespace {

/// Does anything go by the liquid that vertices see?
bool asksForLiquidAround(const CouplingSettings& coupling)
{
    return coupling.capture.rate > 0.0 || (coupling.drag != DragLaw::Off && coupling.dragFraction == DragFraction::Fabric);
}

/// Are vertices of the fabric in cells of the liquid, and do they see any of it?
bool findVerticesInLiquid(StepContext& c)
{
    Coupling& coupling = *c.work.coupling;
    coupling.vertices.sort(c.state.grid, c.state.fabric);
    if (coupling.vertices.empty()) return false;
    return !asksForLiquidAround(c.settings().coupling) ||
           coupling.around.find(c.state.grid, c.work.order, c.state.liquid, c.work.obstacleField, coupling.vertices);
}

}  // namespace

void capture(StepContext& c)
{
    if (!c.plan.isWet || !c.work.coupling || !reachesLiquid(c.state.grid, c.state.fabric)) return;
    const StageScope scope(c.clock, Stage::Capture);
    State& state = c.state;
    Coupling& coupling = *c.work.coupling;
    c.plan.overlapsFabric = findVerticesInLiquid(c);
    if (!c.plan.overlapsFabric) return;
    const ExchangeWatch watch(coupling.fabric, state, &c.work.order);
    coupling.twist.store(coupling.fabric, state.fabric);
    c.report.capturedMass = coupling.capture.capture(c.dt, state.grid, c.work.order, coupling.vertices, state.liquid, state.fabric);
    coupling.twist.restore(coupling.fabric, state.fabric);
    watch.expectKept(coupling.capture.pinImpulse());
    c.work.momentum.exchanged(state, coupling.capture.pinImpulseByVertex());
    c.energy.taken(EnergyChange::Capture);
}

void deleteCaptured(StepContext& c)
{
    if (!c.plan.overlapsFabric) return;
    const StageScope scope(c.clock, Stage::Capture);
    c.work.coupling->capture.removeEmptyParticles(c.state.liquid);
}

void wick(StepContext& c)
{
    State& state = c.state;
    c.plan.fabricIsWet = c.work.coupling && c.work.coupling->wicking.isWet(state.fabric);
    if (!c.plan.fabricIsWet) return;
    const StageScope scope(c.clock, Stage::Wicking);
    Coupling& coupling = *c.work.coupling;
    {
        const ExchangeWatch watch(coupling.fabric, state, nullptr);
        coupling.wicking.move(c.dt, c.gravityOnFabric(), state.grid, state.pressure, coupling.velocityBefore, state.fabric);
        watch.expectKept(coupling.wicking.pinImpulse());
    }
    c.work.momentum.exchanged(state, coupling.wicking.pinImpulseByVertex());
    c.energy.taken(EnergyChange::Wicking);
}

void drip(StepContext& c)
{
    if (!c.plan.fabricIsWet || !c.settings().coupling.drip) return;
    const StageScope scope(c.clock, Stage::Drip);
    State& state = c.state;
    const LiquidParticles& particles = state.liquid;
    const std::size_t before = particles.count;
    {
        const ExchangeWatch watch(c.work.coupling->fabric, state, nullptr);
        c.work.obstacles.moveTo(state.time, state.time + c.dt);  // for scenes in which no liquid has moved yet
        c.report.drippedMass = c.work.coupling->drip.drip(state, c.work.obstacles);
        watch.expectKept(Vec3::Zero());
    }
    for (std::size_t p = before; p < particles.count; ++p) {
        c.report.energies.kinetic += 0.5 * particles.mass[p] * particles.velocity(p).squaredNorm();
        c.report.energies.potential -= particles.mass[p] * c.settings().gravity.dot(particles.position(p));
    }
    c.report.liquidMass += c.report.drippedMass;
    c.work.momentum.exchanged(state, {});
    c.energy.after(EnergyChange::Drip);
}

}  // namespace sim
