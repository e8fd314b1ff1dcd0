#include "sim/coupling/exchange_watch.h"
#include "sim/stages/stages.h"

namespace sim {

namespace {

/// Does anything go by the liquid that vertices see?
bool asksForLiquidAround(const CouplingSettings& coupling) { return coupling.capture.rate > 0.0 || isDragByFabric(coupling); }

/// The vertices of the fabric that are in cells of the liquid, if they see any of it.
void findVerticesInLiquid(StepContext& c)
{
    Coupling& coupling = *c.work.coupling;
    SortedVertices& vertices = coupling.sorter.sort(c.state.grid, c.state.fabric);
    if (vertices.empty()) return;
    const bool asks = asksForLiquidAround(c.settings().coupling);
    if (asks) c.plan.aroundFabric = coupling.around.find({c.state.liquid, c.work.order, c.state.grid}, c.work.obstacleField, vertices);
    if (!asks || c.plan.aroundFabric) c.plan.vertices = &vertices;
}

}  // namespace

void capture(StepContext& c)
{
    if (!c.plan.isWet || !c.work.coupling || !reachesLiquid(c.state.grid, c.state.fabric)) return;
    const StageScope scope(c.clock, Stage::Capture);
    State& state = c.state;
    Coupling& coupling = *c.work.coupling;
    findVerticesInLiquid(c);
    if (!c.plan.aroundFabric) return;
    const ExchangeWatch watch(coupling.fabric, state, &c.work.order);
    coupling.twist.keep(coupling.fabric, state.fabric,
                        [&] { c.plan.uptake = coupling.capture.capture(c.dt, *c.plan.aroundFabric, state.liquid, state.fabric); });
    c.report.capturedMass = c.plan.uptake->mass;
    watch.expectKept(c.plan.uptake->pinImpulse);
    c.work.momentum.exchanged(state, c.plan.uptake->pinImpulse);
    c.energy.taken(EnergyChange::Capture, c.plan.uptake->pinImpulse);
}

void deleteCaptured(StepContext& c)
{
    if (!c.plan.uptake) return;
    const StageScope scope(c.clock, Stage::Capture);
    Capture::removeEmptyParticles(*c.plan.uptake, c.state.liquid);
}

void wick(StepContext& c)
{
    State& state = c.state;
    c.plan.fabricIsWet = c.work.coupling && c.work.coupling->wicking.isWet(state.fabric);
    if (!c.plan.fabricIsWet) return;
    const StageScope scope(c.clock, Stage::Wicking);
    Coupling& coupling = *c.work.coupling;
    const ExchangeWatch watch(coupling.fabric, state, nullptr);
    const std::span<const Vec3> pinImpulse =
        coupling.wicking.move(c.dt, c.gravityOnFabric(), state.grid, state.pressure, coupling.velocityBefore, state.fabric);
    watch.expectKept(pinImpulse);
    c.work.momentum.exchanged(state, pinImpulse);
    c.energy.taken(EnergyChange::Wicking, pinImpulse);
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
        watch.expectKept({});
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
