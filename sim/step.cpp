#include "sim/step.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/coupling/exchange_watch.h"
#include "sim/energy_book.h"
#include "sim/liquid/energy.h"
#include "sim/liquid_step.h"
#include "sim/particles/emit.h"

#include <cmath>
#include <optional>

namespace sim {

namespace {

/// The fabric, and the liquid between it.
void stepFabric(State& state, const Vec3& gravity, Workspace& work, double dt, const LiquidPlan& plan, StepReport& report, StageClock& clock)
{
    if (plan.isMixed) clock.start(Stage::Mixture);
    if (work.fabric || work.ledFabric) {
        const LiquidLoads* loads = plan.isMixed ? &work.coupling->mixture.loads(work.grid) : nullptr;
        if (work.ledFabric) report.fabric = work.ledFabric->step(state.time, dt, gravity, state.fabric, loads);
        else report.fabric = work.fabric->step(state.time, dt, gravity, state.fabric, clock, loads);
        if (work.fabric && work.kept) report.fabric.deepest = work.fabric->deepestInObstacles(state.fabric);
        if (!plan.isMixed) return;
        clock.start(Stage::Mixture);
        work.coupling->mixture.separate(state.fabric, work.grid);
    }
    if (work.gridFabric) {
        std::optional<FaceLoads> loads;
        if (plan.isMixed) loads.emplace(work.coupling->mixture.faceLoads(work.grid));
        if (!plan.meetsFabric) work.gridFabric->spread(state.fabric, clock);
        report.fabric = work.gridFabric->advance(state.time, dt, gravity, state.fabric, clock, loads ? &*loads : nullptr);
        if (work.kept) report.fabric.deepest = work.gridFabric->deepestInObstacles(state.fabric);
        if (!plan.isMixed) return;
        clock.start(Stage::Mixture);
        work.coupling->mixture.separate(work.gridFabric->faces(), work.grid);
    }
}

/// Liquid that moves in the fabric, and that leaves it.
/// @param gravity  meanGravity of the step
void exchange(State& state, const Settings& settings, const Vec3& gravity, Workspace& work, double dt, const LiquidPlan& plan,
              StepReport& report, StageClock& clock, EnergyBook& energy)
{
    Coupling& coupling = *work.coupling;
    LiquidParticles& particles = state.liquid;
    if (plan.meetsFabric) coupling.capture.dropEmptied(particles);
    if (coupling.wicking.isWet(state.fabric)) {
        clock.start(Stage::Wicking);
        {
            const ExchangeWatch watch(coupling.fabric, state, nullptr);
            coupling.wicking.move(dt, gravity, state.grid, state.pressure, coupling.velocityBefore, state.fabric);
            watch.expectKept(coupling.wicking.toPins());
        }
        work.momentum.exchanged(state, coupling.wicking.toPinsByVertex());
        energy.taken(EnergyChange::Wicking);
        if (settings.coupling.drip) {
            clock.start(Stage::Drip);
            const std::size_t before = particles.count;
            const ExchangeWatch watch(coupling.fabric, state, nullptr);
            work.obstacles.moveTo(state.time, state.time + dt);  // for scenes in which no liquid has moved yet
            report.drippedMass = coupling.drip.drip(state, work.obstacles);
            watch.expectKept(Vec3::Zero());
            for (std::size_t p = before; p < particles.count; ++p) {
                report.energies.kinetic += 0.5 * particles.mass[p] * particles.velocity(p).squaredNorm();
                report.energies.potential -= particles.mass[p] * settings.gravity.dot(particles.position(p));
            }
            work.momentum.exchanged(state, {});
            energy.after(EnergyChange::Drip);
        }
    }
    report.particles = particles.count;
    report.liquidMass += report.drippedMass;
    report.absorbedMass = parallelSum(state.fabric.absorbed.size(), [&](std::size_t v) { return state.fabric.absorbed[v]; });
    [[maybe_unused]] const Ledger& ledger = state.ledger;
    SIM_CHECK(std::abs(report.liquidMass + report.absorbedMass + ledger.leftMass - ledger.emittedMass) <=
              1.0e-12 * ledger.emittedMass);  // (coupling/README.md, What is kept)
}

void findFabricEnergies(const State& state, const Settings& settings, const Workspace& work, StepReport& report)
{
    if (work.fabric) report.energies.fabric = work.fabric->energies(state.fabric, settings.gravity);
    if (work.gridFabric) report.energies.fabric = work.gridFabric->energies(state.fabric, settings.gravity);
    if (work.ledFabric) report.energies.fabric = work.ledFabric->energies(state.fabric, settings.gravity);
    if (std::isfinite(report.energies.fabric.total())) return;
    report.failure = "the fabric's energy is not finite";
    report.failedStage = Stage::FabricSolve;
}

}  // namespace

double potentialLag(const State& state, const Settings& settings)
{
    if (!settings.time.reflects() || state.reflected) return 0.0;
    return weightWork(state.liquid, settings.gravity, 0.5 * state.lastDt);
}

bool mayReflect(const State& state, const TimeSettings& time, const Workspace& work)
{
    return time.reflects() && hasLiquid(state) && !(work.coupling && reachesLiquid(state.grid, state.fabric));
}

namespace {

void step(State& state, const Scene& scene, Workspace& work, double dt, StepReport& report, StageClock& clock)
{
    EnergyBook energy(state, scene.settings, work, report);
    const bool reflects = mayReflect(state, scene.settings.time, work) && !state.reflected;

    work.momentum.begin(dt, state);
    work.emission.inflows.clear();
    if (emits(scene, state, state.time, state.time + dt)) {
        clock.start(Stage::Emit);
        const std::size_t before = state.liquid.count;
        emitLiquid(scene, state, state.time, state.time + dt, work.emission);
        for (std::size_t p = before; p < state.liquid.count; ++p)
            report.emittedKinetic += 0.5 * state.liquid.mass[p] * state.liquid.velocity(p).squaredNorm();
        work.momentum.entered(state, before);
    }
    const bool isWet = hasLiquid(state);
    LiquidPlan plan;
    if (isWet) plan = startLiquid(state, scene, work, dt, reflects, report, clock, energy);
    if (work.coupling) work.coupling->velocityBefore = state.fabric.v;
    const Vec3 gravity = meanGravity(scene.settings, state, dt, plan.meetsFabric);
    stepFabric(state, gravity, work, dt, plan, report, clock);
    if (work.fabric || work.gridFabric) work.momentum.fabricMoved(dt, gravity, state);
    energy.solved(plan.isMixed, dt, gravity, report.fabric);
    if (isWet) finishLiquid(state, scene, work, dt, plan, report, clock, energy);
    if (work.coupling) exchange(state, scene.settings, gravity, work, dt, plan, report, clock, energy);
    findFabricEnergies(state, scene.settings, work, report);
    work.momentum.finish();
    for (const Impulse& pins : work.momentum.forces().pins) report.toPins += pins.linear;

    state.time += dt;
    ++state.step;
    state.lastDt = dt;
    state.reflected = report.isReflected = plan.reflects;
    report.energies.potential += potentialLag(state, scene.settings);
    energy.finished();
}

}  // namespace

StepReport step(State& state, const Scene& scene, Workspace& work, double dt)
{
    StepReport report;
    report.dt = dt;
    StageClock clock(report);
    try {
        step(state, scene, work, dt, report, clock);
    } catch (const RunError&) {
        work.failedStage = clock.last();
        throw;
    }
    return report;
}

}  // namespace sim
