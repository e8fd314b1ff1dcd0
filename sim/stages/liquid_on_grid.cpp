#include "sim/core/parallel.h"
#include "sim/liquid/cells.h"
#include "sim/liquid/energy.h"
#include "sim/liquid/face_velocity.h"
#include "sim/liquid/walls.h"
#include "sim/stages/stages.h"
#include "sim/transfer/scatter_bounded.h"

namespace sim {

void particlesToGrid(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::ParticlesToGrid);
    const BlockGrid& grid = c.state.grid;
    const TransferSettings& transfer = c.settings().transfer;
    Workspace& work = c.work;
    const SortedParticles sorted{c.state.liquid, work.order, grid};
    if (differsFromTranslation(transfer.xi, transfer.modeCount())) {
        const LiquidEnergies own = liquidEnergies(c.state.liquid, grid, c.settings().gravity, &work.order);
        particlesToFacesBounded(sorted, transfer.xi, c.state.lastDt, own.kinetic + own.modal, work.bounded, work.grid.faces);
    } else particlesToFaces(sorted, work.scatter, work.grid.faces);
    work.momentum.liquidOnFaces(work.grid.faces, grid.count());
    if (c.hasObstacles()) work.onSolids.begin(c.cut(), work.grid.faces);
    if (c.mirrorsAtWalls()) mirrorAtWalls(grid, work.obstacles, c.settings().liquid.wallFriction, work.obstacleField, work.wallFaces, work.grid);
    c.energy.toGrid();
}

void applyGravity(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::ParticlesToGrid);
    const BlockGrid& grid = c.state.grid;
    const Vec3& gravity = c.settings().gravity;
    computeFaceVelocities(grid, gravity, c.fallTime(), c.keepsAdvected(), c.work.grid);
    if (c.mirrorsAtWalls()) withholdWeightOfImages(c.work.obstacleField, gravity, c.fallTime(), c.work.grid);
    c.work.grid.unpressed = c.work.grid.faces.velocity;
    c.work.openings.weigh(c.work.grid, c.fallTime() * gravity);
    c.work.openings.followMean(c.work.grid, gravity.norm(), c.dt, c.state.memory.openings);
    c.energy.onFaces(EnergyChange::Gravity);
}

void applyViscosity(StepContext& c)
{
    if (!c.isViscous()) return;
    const StageScope scope(c.clock, Stage::Viscosity);
    Workspace& work = c.work;
    std::optional<LiquidOnSolids::KeptVelocities> kept;
    if (c.hasObstacles()) kept = work.onSolids.keepVelocities(work.grid.faces.velocity);
    c.report.viscosity = solveViscosity(c.cut(), c.settings().liquid, c.settings().solver, c.fallTime(), work.viscosity, work.grid);
    const double bySolids = kept ? work.onSolids.afterViscosity(*kept, c.cut(), work.viscosity.system, work.grid) : 0.0;
    const double byOpenings = work.openings.viscousWork(c.cut(), work.grid, work.viscosity.withheld);
    c.report.inflowWork += byOpenings;
    BlockArray<double, 3>& velocity = work.grid.faces.velocity;
    parallelFor(velocity.size(), 4096, [&](std::size_t i) { velocity.block(0)[i] += work.viscosity.withheld.block(0)[i]; });
    if (c.correctsStrain()) {
        const double *now = velocity.block(0), *weighed = work.grid.unpressed.block(0), *before = work.grid.advected.block(0);
        work.strain.viscous.resize(c.state.grid.count());
        double* viscous = work.strain.viscous.block(0);
        parallelFor(velocity.size(), 4096, [&](std::size_t i) { viscous[i] = before[i] + (now[i] - weighed[i]); });
    }
    work.grid.unpressed = velocity;
    c.energy.viscosity(bySolids, byOpenings);
}

void findCells(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::Cells);
    LiquidGrid& liquid = c.work.grid;
    c.plan.surfaceCells = findSurface(c.cut(), findLiquidCells(c.cut(), c.settings().liquid.full, liquid), liquid);
}

}  // namespace sim
