#include "sim/core/parallel.h"
#include "sim/liquid/pressure.h"
#include "sim/liquid/relax_at_walls.h"
#include "sim/sources/emit.h"
#include "sim/sources/enter_openings.h"
#include "sim/stages/correction.h"
#include "sim/stages/stages.h"

namespace sim {

namespace {

/// Pressure of the last step, in the blocks of this one.
void remapPressure(const BlockGrid& grid, const ParticleOrder& order, BlockArray<double>& old, BlockArray<double>& pressure)
{
    if (!order.blocksChanged) return;
    old.swap(pressure);
    pressure.resize(grid.count());
    parallelFor(grid.count(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n), from = order.previous[b];
        if (from == BlockGrid::kNone) std::fill_n(pressure.block(b), kBlockCells, 0.0);
        else std::copy_n(old.block(from), kBlockCells, pressure.block(b));
    });
}

/// The first solve of a step starts from what it will find: without what the strain correction added, and without what the step before this one
/// reflected.
void expectPressure(StepContext& c)
{
    State& state = c.state;
    Workspace& work = c.work;
    remapPressure(state.grid, work.order, work.oldPressure, state.pressure);
    if (state.pressureOfStrain.size() > 0) {
        remapPressure(state.grid, work.order, work.oldPressure, state.pressureOfStrain);
        addPressure(-1.0, state.pressureOfStrain, state.grid, state.pressure);
        if (!c.correctsStrain()) state.pressureOfStrain = {};
    }
    if (state.reflected) {
        remapPressure(state.grid, work.order, work.oldPressure, state.pressureOfReflection);
        addPressure(-1.0, state.pressureOfReflection, state.grid, state.pressure);
    }
}

}  // namespace

void emit(StepContext& c)
{
    State& state = c.state;
    c.work.emission.inflows.clear();
    const bool areSourcesActive = emits(c.scene, state, state.time, state.time + c.dt);
    if (!areSourcesActive && c.scene.openings.empty()) return;
    const StageScope scope(c.clock, Stage::Emit);
    const std::size_t before = state.liquid.count;
    if (areSourcesActive) emitLiquid(c.scene, state, state.time, state.time + c.dt, c.work.emission);
    enterOpenings(c.scene, c.work.packing, c.dt, state, c.work.passage);
    for (std::size_t p = before; p < state.liquid.count; ++p)
        c.report.emittedKinetic += 0.5 * state.liquid.mass[p] * state.liquid.velocity(p).squaredNorm();
    c.work.momentum.entered(state, before);
}

void sort(StepContext& c)
{
    State& state = c.state;
    Workspace& work = c.work;
    BlockGrid& grid = state.grid;
    c.plan.isWet = hasLiquid(state);
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::Sort);
    sortParticles(state.liquid, grid, c.scene.domain ? &*c.scene.domain : nullptr, work.order, &state.ledger);
    expectPressure(c);
    work.grid.resize(grid.count(), c.keepsAdvected());
    work.grid.fullMass = work.packing * c.settings().liquid.density * grid.dx * grid.dx * grid.dx;
    work.openings.find(grid, work.grid);
    work.momentum.left(state);
    c.energy.sorted();
}

void findObstacles(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock);
    if (c.hasObstacles()) c.clock.start(Stage::Obstacles);
    // Particles are outside the solids where these are when the step begins.
    c.work.obstacles.startAt(c.state.time, c.state.time + c.dt);
    c.work.obstacleField.update(c.state.grid, c.work.order.previous, c.work.obstacles, usesMirrorBoundary(c.settings().liquid.wallFriction));
}

void relax(StepContext& c)
{
    if (!c.plan.isWet) return;
    State& state = c.state;
    Workspace& work = c.work;
    const double rate = c.settings().liquid.relax.rate;
    state.unrelaxed += c.dt;
    c.plan.relaxes = work.relaxReach > 0.0 && isDue(rate, state.unrelaxed, c.dt);
    if (!c.plan.relaxes) return;
    const StageScope scope(c.clock, Stage::Relax);
    relaxationDisplacements({state.liquid, work.order, state.grid}, rate, work.relaxReach, state.unrelaxed, work.relax, work.displacement);
    keepRelaxationFromLifting(work.order, c.cut(), c.settings().gravity, work.relaxReach, state.liquid, work.displacement);
    state.unrelaxed = 0.0;
}

}  // namespace sim
