#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/liquid/cells.h"
#include "sim/liquid/deep_faces.h"
#include "sim/liquid/inflow.h"
#include "sim/liquid/surface_weight.h"
#include "sim/stages/correction.h"
#include "sim/stages/stages.h"

#include <algorithm>

namespace sim {

namespace {

/// Largest share of an error of volume that a long step corrects; to correct all of it at once would overshoot [-].
constexpr double kLargestShare = 0.5;

/// What pressure and surface tension have changed of velocities [cm/s], in FreeLiquid::change.
void findChange(const BlockArray<double, 3>& velocity, int blocks, Workspace& work)
{
    work.free.change.resize(blocks);
    parallelFor(blocks, 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const double *now = velocity.block(b), *before = work.grid.unpressed.block(b);
        double* by = work.free.change.block(b);
        for (std::size_t i = 0; i < BlockArray<double, 3>::kStride; ++i) by[i] = now[i] - before[i];
    });
}

/// Faces on which neither a solid nor an opening holds the liquid.
UnheldFaces findUnheld(StepContext& c)
{
    const UnheldFaces unheld = findUnheldFaces(c.cut(), c.work.free);
    c.work.openings.takeHeld(c.work.free.unheld);
    return unheld;
}

/// What weight does in a step, for the pressure beyond openings.
Openings::Push pushOf(const StepContext& c) { return {c.settings().gravity, c.settings().liquid.density, c.fallTime(), c.dt}; }

/// Impulse on a face amid liquid by the step of the pressure [cm^2 s].
double perPressure(const StepContext& c) { return c.dt * c.work.grid.fullMass / (c.settings().liquid.density * c.state.grid.dx); }

/// Faces of the system for the pressure, which does not act in the planes of inlets.
PressureFaces pressureFaces(StepContext& c, const SurfaceCells& cells)
{
    PressureFaces faces = findPressureFaces(c.cut(), c.settings().liquid, c.dt, cells, c.work.pressure);
    c.work.openings.closeInlets(faces);
    return faces;
}

/// Pressure and surface tension leave free liquid, and fabric that it carries along, the momentum that they have.
/// @param velocity  of the faces, after both
void restoreMomentum(StepContext& c, BlockArray<double, 3>& velocity)
{
    const BlockGrid& grid = c.state.grid;
    Workspace& work = c.work;
    const UnheldFaces unheld = findUnheld(c);
    const bool carries = c.plan.eliminatedDrag && c.settings().coupling.pressureOnFabric;
    if (!carries && c.plan.sharedFaces) work.coupling->mixture.clearShared(*c.plan.sharedFaces, work.free.unheld);
    c.plan.heldBodies = findHeldBodies(grid, *c.plan.pressure, unheld);
    if (std::ranges::any_of(work.free.bodies, [](const FreeLiquid::Body& body) { return !body.isHeld; })) {
        findChange(velocity, grid.count(), work);
        if (carries) work.coupling->mixture.toMassesOfBoth(*c.plan.eliminatedDrag, work.grid, work.free.change);
        takeMeans(grid, *c.plan.heldBodies, work.free.change, work.free, velocity);
        if (carries) work.coupling->mixture.fromMassesOfBoth(*c.plan.eliminatedDrag, work.grid);
    }
    if (c.hasObstacles()) work.gainAtWalls.bound(work.obstacleField, velocity);
}

/// Settings of a solve that another follows.
SolverSettings roughly(SolverSettings solver)
{
    solver.pressureTolerance = std::max(solver.pressureTolerance, std::min(1.0e-3, 1.0e3 * solver.pressureTolerance));
    return solver;
}

/// Faces with a part in the strain correction: all but those that fabric is on.
void findStrainedFaces(StepContext& c)
{
    BlockBits<3>& acts = c.work.strain.acts;
    acts.resize(c.state.grid.count());
    std::fill_n(acts.block(0), static_cast<std::size_t>(c.state.grid.count()) * kAxes * BlockBits<3>::kWords, ~std::uint64_t{0});
    if (c.plan.sharedFaces) c.work.coupling->mixture.clearShared(*c.plan.sharedFaces, acts);
}

/// Add the pressure that took out the divergence of the strain correction to that before it.
void addToPressure(const SolveReport& again, StepContext& c)
{
    addPressure(1.0, c.state.pressureOfStrain, c.state.grid, c.state.pressure);
    SolveReport& report = c.report.pressure;
    report.iterations += again.iterations;
    report.converged = again.converged;
    if (report.scale > 0.0) report.residual = again.residual * again.scale / report.scale;
}

/// Liquid that nothing holds has the masses that P2G gave it amid itself, too. Where fabric goes through liquid they stay full.
bool weighFreeLiquid(StepContext& c, const PressureComponents& system, PressureFaces& faces)
{
    if (c.plan.isMixed() || c.settings().liquid.full) return false;
    return weighDeepFaces(c.cut(), findHeldBodies(c.state.grid, system, findUnheld(c)), faces);
}

/// Is there weight that solids may hold?
bool hasHeldWeight(const StepContext& c) { return c.hasObstacles() && !c.settings().gravity.isZero(0.0); }

/// Take the noise out of the weight of liquid that solids hold. Fabric that goes through it keeps what is on its faces.
/// @param onSolids  is told, if not null
void levelHeldWeight(StepContext& c, const PressureComponents& system, LiquidOnSolids* onSolids)
{
    const BlockGrid& grid = c.state.grid;
    Workspace& work = c.work;
    work.free.hasFabric = c.plan.isMixed();
    if (work.free.hasFabric) {
        work.free.bare.resize(grid.count());
        std::fill_n(work.free.bare.block(0), static_cast<std::size_t>(grid.count()) * kAxes * BlockBits<3>::kWords, ~std::uint64_t{0});
        work.coupling->mixture.clearShared(*c.plan.sharedFaces, work.free.bare);
    }
    const Vec3 gravityStep = c.fallTime() * c.settings().gravity;
    const bool weighsImages = c.mirrorsAtWalls() && work.openings.empty();  // pressure beyond outlets goes by what images hold in their planes
    if (weighsImages) levelWeightOfImages(c.cut(), work.free.hasFabric ? &work.free.bare : nullptr, gravityStep, work.grid);
    if (c.settings().liquid.full) return;  // there is no surface
    levelWeight(c.cut(), findHeldBodies(grid, system, findUnheld(c)), gravityStep, work.grid, onSolids, work.beyond);
}

}  // namespace

void findSurfaceTension(StepContext& c)
{
    if (!c.plan.isWet || !feelsSurfaceTension(c.settings().liquid)) return;
    const StageScope scope(c.clock, Stage::SurfaceTension);
    c.plan.surfaceSteps = findSurfaceSteps(c.cut(), c.settings().liquid, *c.plan.surfaceCells, c.work.surfaceTension);
}

void withholdPressure(StepContext& c)
{
    if (!c.isViscous()) return;
    const StageScope scope(c.clock, Stage::Viscosity);
    Workspace& work = c.work;
    BlockArray<double, 3>& velocity = work.grid.faces.velocity;
    work.viscosity.withheld = velocity;
    const SurfaceCells cells = findSurface(c.cut(), findLiquidCells(c.cut(), c.settings().liquid.full, work.grid), work.grid);
    const PressureSystem system = preparePressure(pressureFaces(c, cells), c.state.grid);
    if (hasHeldWeight(c)) levelHeldWeight(c, system, nullptr);
    work.openings.drive(c.cut(), pushOf(c), system, c.state.memory.openings, work.grid);
    c.report.withheld = solvePressure(c.cut(), c.settings().solver, {}, system, work.grid, c.state.pressure);
    work.openings.keepMoved(velocity);
    parallelFor(velocity.size(), 4096, [&](std::size_t i) { work.viscosity.withheld.block(0)[i] -= velocity.block(0)[i]; });
}

void assemblePressure(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::Pressure);
    const BlockGrid& grid = c.state.grid;
    Workspace& work = c.work;
    PressureFaces faces = pressureFaces(c, *c.plan.surfaceCells);
    if (c.plan.sharedFaces)
        c.plan.eliminatedDrag = work.coupling->mixture.eliminateDrag(*c.plan.sharedFaces, work.obstacleField, work.grid, faces.coefficient());
    PressureMatrix matrix = assembleMatrix(faces, grid);
    const PressureComponents components = findComponents(matrix, grid);
    if (weighFreeLiquid(c, components, faces)) matrix = assembleMatrix(faces, grid);
    c.plan.pressure = buildHierarchy(matrix, components, grid);
}

void levelWeight(StepContext& c)
{
    if (!c.plan.isWet || !hasHeldWeight(c)) return;
    const StageScope scope(c.clock, Stage::Pressure);
    c.energy.remember();
    levelHeldWeight(c, *c.plan.pressure, &c.work.onSolids);
    c.energy.levelled();
}

void applySurfaceTension(StepContext& c)
{
    if (!c.plan.surfaceSteps) return;
    const StageScope scope(c.clock, Stage::SurfaceTension);
    c.energy.remember();
    applySurfaceSteps(c.cut(), *c.plan.pressure, c.fallTime() / c.dt, *c.plan.surfaceSteps, c.work.grid);
    c.energy.surfaceTension(c.plan.sharedFaces);
}

void driveOpenings(StepContext& c)
{
    if (!c.plan.isWet || c.work.openings.empty()) return;
    const StageScope scope(c.clock, Stage::Pressure);
    Workspace& work = c.work;
    work.openings.drive(c.cut(), pushOf(c), *c.plan.pressure, c.state.memory.openings, work.grid);
}

void project(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::Pressure);
    Workspace& work = c.work;
    if (c.hasObstacles()) work.gainAtWalls.begin(work.obstacleField, work.grid.faces.velocity);
    findInflowCells(c.state.grid, *c.plan.pressure, work.emission.inflows, work.packing, c.dt, work.inflow);
    const SolverSettings solver = c.correctsStrain() ? roughly(c.settings().solver) : c.settings().solver;
    c.report.pressure = solvePressure(c.cut(), solver, work.inflow, *c.plan.pressure, work.grid, c.state.pressure);
}

void correctStrain(StepContext& c)
{
    if (!c.correctsStrain()) return;
    const StageScope scope(c.clock, Stage::StrainCorrection);
    Workspace& work = c.work;
    const SolverSettings& solver = c.settings().solver;
    const PressureSystem& system = *c.plan.pressure;
    findStrainedFaces(c);
    c.energy.remember();
    std::optional<LiquidOnSolids::KeptVelocities> kept;
    if (c.hasObstacles()) kept = work.onSolids.keepVelocities(work.grid.faces.velocity);
    correctStrain(c.cut(), c.isViscous() ? work.strain.viscous : work.grid.advected, system, work.strain, work.grid);
    if (kept) work.onSolids.afterStrain(*kept, c.cut(), work.strain, work.grid);
    findRightHandSide(c.cut(), system, work.grid.faces.velocity, work.inflow, system.rightHandSide());
    const SolveTolerance tolerance(solver.pressureTolerance, solver.pressureTolerance * c.report.pressure.scale);
    const SolveReport again = system.solve(c.state.grid, tolerance, solver.maxIterations, c.state.pressureOfStrain);
    subtractGradient(c.cut(), system, c.state.pressureOfStrain, work.grid);
    c.energy.strainCorrected();
    addToPressure(again, c);
}

void bookInflowWork(StepContext& c)
{
    if (!c.plan.isWet || c.work.emission.inflows.empty()) return;
    const StageScope scope(c.clock, Stage::Pressure);
    Workspace& work = c.work;
    const BlockGrid& grid = c.state.grid;
    const double done = inflowWork(grid, work.inflow, c.state.pressure, c.dt);
    c.report.inflowWork += done;
    for (const Inflow& inflow : work.emission.inflows) {
        const bool isShut = isShutIn(inflow.source, work.inflow, grid, *c.plan.pressure);
        c.state.memory.sources[inflow.source].isShut = isShut ? 1.0 : 0.0;
    }
    c.energy.pressedIn(done);
}

void passOpenings(StepContext& c)
{
    if (!c.plan.isWet || c.work.openings.empty()) return;
    const StageScope scope(c.clock, Stage::Pressure);
    Workspace& work = c.work;
    const Openings::Carried carried = work.openings.carry(c.cut(), work.grid, work.grid.faces.velocity);
    double done = work.openings.driven() + carried.gained;
    done += work.openings.pressureWork(c.cut(), work.grid, c.state.pressure, perPressure(c));
    c.report.inflowWork += done;
    c.energy.pressedIn(done);
    c.energy.heldByOpenings(work.openings.heldWeight() + carried.held);
    for (std::size_t n = 0; n < c.scene.openings.size(); ++n) {
        work.openings.findInletCells(*c.plan.pressure, n, work.shutInlets);
        if (!isShutIn(n, work.shutInlets, c.state.grid, *c.plan.pressure)) continue;
        throw RunError(c.scene.openings[n].where + ": inlet " + c.scene.openings[n].name +
                       " has filled all that it leads to; give the liquid an outlet, or stop before");
    }
}

void correctVolume(StepContext& c)
{
    if (!c.plan.isWet) return;
    State& state = c.state;
    Workspace& work = c.work;
    const double rate = c.settings().liquid.volume.rate;
    state.uncorrected += c.dt;
    c.plan.correctsVolume = isDue(rate, state.uncorrected, c.dt);
    if (!c.plan.correctsVolume) return;
    const StageScope scope(c.clock, Stage::Volume);
    const double strength = std::min(kLargestShare, rate * state.uncorrected);
    c.report.volume = correctVolume(c.cut(), c.settings(), strength, *c.plan.pressure, work.volume);
    state.uncorrected = 0.0;
    const UnheldFaces unheld = findUnheld(c);
    if (c.plan.sharedFaces) work.coupling->mixture.clearShared(*c.plan.sharedFaces, work.free.unheld);
    const HeldBodies bodies = findHeldBodies(state.grid, *c.plan.pressure, unheld);
    takeMeans(state.grid, bodies, work.volume.displacement, work.free, work.volume.displacement);
}

void conserveMomentum(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::Pressure);
    restoreMomentum(c, c.work.grid.faces.velocity);
}

void reflect(StepContext& c)
{
    if (!c.plan.reflects) return;
    const StageScope scope(c.clock, Stage::Reflection);
    Workspace& work = c.work;
    const MovingSurface surface{work.free.held, c.isFrameMoving() ? work.free.frames.data() : nullptr, c.settings().liquid.density, c.dt};
    work.openings.swapAtInlets(work.grid.advected);
    c.report.reflection = reflect(c.cut(), c.settings().solver, work.inflow, *c.plan.pressure, surface, work.reflection);
    work.openings.swapAtInlets(work.grid.advected);
    restoreMomentum(c, work.reflection.velocity);
    work.openings.carry(c.cut(), work.grid, work.reflection.velocity);
    c.energy.reflected(c.dt, work.openings.inletWork(c.cut(), work.grid, work.reflection.potential, perPressure(c)));
}

void completePressure(StepContext& c)
{
    State& state = c.state;
    if (state.reflected) addPressure(1.0, state.pressureOfReflection, state.grid, state.pressure);
    if (c.plan.reflects) state.pressureOfReflection.swap(c.work.reflection.potential);
}

}  // namespace sim
