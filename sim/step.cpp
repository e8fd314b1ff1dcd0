#include "sim/step.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/stages/stages.h"
#include "sim/step_context.h"
#include "sim/time_step.h"

#include <cmath>

namespace sim {

namespace {

void begin(StepContext& c)
{
    c.plan.reflects = mayReflect(c.state, c.settings().time, c.work) && !c.state.reflected;
    c.work.momentum.begin(c.dt, c.state);
}

/// Masses of the liquid and of what the fabric holds, which add up to all that has entered (coupling/README.md, What is kept).
void sumMasses(const State& state, bool hasCoupling, StepReport& report)
{
    report.particles = state.liquid.count;
    if (!hasCoupling) return;
    report.absorbedMass = parallelSum(state.fabric.absorbed.size(), [&](std::size_t v) { return state.fabric.absorbed[v]; });
    [[maybe_unused]] const Ledger& ledger = state.ledger;
    SIM_CHECK(std::abs(report.liquidMass + report.absorbedMass + ledger.leftMass - ledger.emittedMass) <= 1.0e-12 * ledger.emittedMass);
}

void findFabricEnergies(StepContext& c)
{
    if (!c.work.fabric) return;
    const StageScope scope(c.clock, Stage::FabricElastic);
    c.report.energies.fabric = c.work.fabric->energies(c.state.fabric, c.settings().gravity);
    if (std::isfinite(c.report.energies.fabric.total())) return;
    c.report.failure = "the fabric's energy is not finite";
    c.report.failedStage = Stage::FabricSolve;
}

/// The state is that of the end of the step.
void finish(StepContext& c)
{
    State& state = c.state;
    StepReport& report = c.report;
    completePressure(c);
    sumMasses(state, c.work.coupling != nullptr, report);
    c.work.momentum.finish();
    for (const Impulse& pins : c.work.momentum.forces().pins) report.pinImpulse += pins.linear;
    state.time += c.dt;
    ++state.step;
    state.lastDt = c.dt;
    state.reflected = report.isReflected = c.plan.reflects;
    report.energies.potential += staggeredPotentialOffset(state, c.settings());
    c.energy.finished();
}

/// The whole step, from top to bottom (sim/README.md, The step).
void runStages(StepContext& c)
{
    begin(c);

    emit(c);
    sort(c);
    findObstacles(c);
    capture(c);
    relax(c);

    particlesToGrid(c);
    applyGravity(c);
    withholdPressure(c);
    applyViscosity(c);
    fabricToGrid(c);
    findMixture(c);

    findCells(c);
    findSurfaceTension(c);
    assemblePressure(c);
    levelWeight(c);
    applySurfaceTension(c);
    driveOpenings(c);
    project(c);
    correctStrain(c);
    bookInflowWork(c);
    correctVolume(c);
    conserveMomentum(c);
    passOpenings(c);

    advanceFabric(c);
    separateMixture(c);
    bookSolution(c);
    removeDisplaced(c);

    findHeld(c);
    reflect(c);
    applyWalls(c);
    pushSolids(c);
    gridToParticles(c);

    deleteCaptured(c);
    wick(c);
    drip(c);
    findFabricEnergies(c);

    finish(c);
}

}  // namespace

StepReport step(State& state, const Scene& scene, Workspace& work, double dt)
{
    StepReport report;
    report.dt = dt;
    StageClock clock(report);
    try {
        StepContext context{scene, state, work, dt, report, clock};
        runStages(context);
    } catch (const RunError&) {
        work.failedStage = clock.last();
        throw;
    }
    return report;
}

}  // namespace sim
