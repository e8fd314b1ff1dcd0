#include "sim/liquid_step.h"

#include "sim/core/parallel.h"
#include "sim/coupling/exchange_watch.h"
#include "sim/liquid/cells.h"
#include "sim/liquid/energy.h"
#include "sim/liquid/face_velocity.h"
#include "sim/liquid/inflow.h"
#include "sim/liquid/push_out.h"
#include "sim/liquid/relax_at_walls.h"
#include "sim/liquid/surface_weight.h"
#include "sim/liquid/walls.h"
#include "sim/transfer/scatter_bounded.h"

#include <cmath>
#include <optional>

namespace sim {

namespace {

/// A factor that is kept per keepDt, as it acts over one step of dt.
double keptOver(double factor, const TransferSettings& transfer, double dt)
{
    return transfer.keepPerStep ? factor : std::pow(factor, dt / transfer.keepDt);
}

GatherSettings gatherSettings(const Scene& scene, const Workspace& work, double dt)
{
    const TransferSettings& transfer = scene.settings.transfer;
    GatherSettings settings;
    settings.dt = dt;
    settings.modes = transfer.modeCount();
    const bool damps = transfer.method == TransferMethod::Apic || (transfer.method == TransferMethod::PolyPic && transfer.dampModes);
    settings.keep = damps ? keptOver(transfer.keepAffine, transfer, dt) : 1.0;
    if (transfer.method == TransferMethod::Flip) {
        settings.flipRatio = keptOver(transfer.flipRatio, transfer, dt);
        settings.flipVelocity = &work.grid.advected;
    }
    if (settings.modes > kModesAtSurface) settings.manyModes = &work.grid.deep;
    return settings;
}

/// Largest share of an error of the particles' places that is mended at once. A correction waits while several short steps together would do less.
constexpr double kGentleCorrection = 0.2;
/// Largest share of an error of volume that a long step mends; to mend all of it at once would overshoot.
constexpr double kLargestShare = 0.5;

/// Is it time for a correction that acts at `rate` [1/s] and was last made `interval` [s] before the end of this step?
bool isDue(double rate, double interval, double dt)
{
    constexpr double kRoundOff = 1.0 + 1.0e-9;  // eight steps of 2e-4 s at the default rates make exactly the gentle share
    return rate > 0.0 && rate * (interval + dt) > kGentleCorrection * kRoundOff;
}

/// Pressure of the last step, in the blocks of this one.
void carryPressureOver(const BlockGrid& grid, const ParticleOrder& order, BlockArray<double>& old, BlockArray<double>& pressure)
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

/// Give the faces behind walls the velocities that the particles in front of them read.
void finishAtWalls(const BlockGrid& grid, const LiquidSettings& settings, const LiquidPlan& plan, Workspace& work)
{
    LiquidGrid& liquid = work.grid;
    const auto apply = [&](BlockBits<3>& valid, BlockArray<double, 3>& velocity) {
        applyWalls(grid, work.obstacleField, work.obstacles, settings.wallFriction, settings.solveViscosity, work.wallFaces, valid, velocity);
    };
    if (plan.flips) {
        liquid.advectedValid = liquid.faces.valid;
        apply(liquid.advectedValid, liquid.advected);
    }
    if (plan.reflects) apply(work.reflection.valid, work.reflection.velocity);
    apply(liquid.faces.valid, liquid.faces.velocity);
}

/// Keep where the particles are before they move.
void keepPlaces(const LiquidParticles& particles, std::array<AlignedArray<double>, kAxes>& places)
{
    for (int a = 0; a < kAxes; ++a) {
        places[a].resize(particles.x[a].size());
        parallelFor(particles.count, 4096, [&](std::size_t p) { places[a][p] = particles.x[a][p]; });
    }
}

/// Of fabric that is solved for on faces.
std::optional<FabricFaces> facesOf(const Workspace& work)
{
    return work.gridFabric ? std::optional(work.gridFabric->faces()) : std::nullopt;
}

/// Take the noise out of the weight of liquid that solids hold. Fabric that goes through it keeps what is on its faces.
/// @param onSolids  is told of it, if not null
/// @return  false where there is none to level
bool levelHeldWeight(const State& state, const Settings& settings, Workspace& work, double fall, bool isMixed, LiquidOnSolids* onSolids)
{
    const BlockGrid& grid = state.grid;
    if (work.obstacles.empty() || settings.liquid.full || settings.gravity.isZero(0.0)) return false;
    findUnheldFaces(grid, work.obstacleField, work.free);
    findHeldBodies(grid, work.pressure, work.grid, work.free);
    if (isMixed) {
        work.free.bare.resize(grid.count());
        std::fill_n(work.free.bare.block(0), static_cast<std::size_t>(grid.count()) * kAxes * BlockBits<3>::kWords, ~std::uint64_t{0});
        work.coupling->mixture.clearShared(work.free.bare);
    }
    levelWeight(grid, work.obstacleField, work.pressure, work.free, isMixed ? &work.free.bare : nullptr, fall * settings.gravity, work.grid, onSolids);
    return true;
}

/// What weight and the pressure against it do to velocities together is no shear. Viscosity in front of the pressure would take the weight
/// for one wherever walls hold the liquid, and set a pool at rest in motion (liquid/README.md, Viscosity). So it acts on the velocities that the pressure
/// would leave without it; what that changed is given back after.
void withholdPressure(State& state, const Settings& settings, Workspace& work, double dt, double fall)
{
    const BlockGrid& grid = state.grid;
    BlockArray<double, 3>& velocity = work.grid.faces.velocity;
    work.viscosity.withheld = work.grid.unpressed = velocity;
    findLiquidCells(grid, work.obstacleField, settings.liquid.full, work.grid);
    findSurface(grid, work.obstacleField, work.grid);
    findPressureFaces(grid, work.obstacleField, settings.liquid, dt, work.grid, work.pressure);
    preparePressure(grid, work.grid, work.pressure);
    levelHeldWeight(state, settings, work, fall, false, nullptr);
    solvePressure(grid, work.obstacleField, settings.solver, {}, work.pressure, work.grid, state.pressure);
    parallelFor(velocity.size(), 4096, [&](std::size_t i) { work.viscosity.withheld.block(0)[i] -= velocity.block(0)[i]; });
}

void giveBack(const BlockArray<double, 3>& withheld, BlockArray<double, 3>& velocity)
{
    parallelFor(velocity.size(), 4096, [&](std::size_t i) { velocity.block(0)[i] += withheld.block(0)[i]; });
}

/// From the particles to velocities on the faces, on which weight and viscosity act for `fall` [s].
void liquidToGrid(State& state, const Settings& settings, Workspace& work, double dt, double fall, bool keepsAdvected, StepReport& report, StageClock& clock,
                  EnergyBook& energy)
{
    const BlockGrid& grid = state.grid;
    clock.start(Stage::ParticlesToGrid);
    if (differsFromTranslation(settings.transfer.xi, settings.transfer.modeCount())) {
        const Energies own = liquidEnergies(state.liquid, grid, settings.gravity, &work.order);
        particlesToFacesBounded(state.liquid, work.order, grid, settings.transfer.xi, state.lastDt, own.kinetic + own.modal, work.bounded,
                                work.grid.faces);
    } else particlesToFaces(state.liquid, work.order, grid, work.scatter, work.grid.faces);
    work.momentum.liquidOnFaces(work.grid.faces, grid.count());
    if (!work.obstacles.empty()) work.onSolids.begin(grid, work.obstacleField, work.obstacles, work.grid.faces);
    const bool mirrors = wallsMirror(settings.liquid.wallFriction) && !work.obstacles.empty();
    if (mirrors) foldAtWalls(grid, work.obstacles, settings.liquid.wallFriction, work.obstacleField, work.wallFaces, work.grid);
    energy.toGrid();
    divideAndAddGravity(grid, settings.gravity, fall, keepsAdvected, work.grid);
    if (mirrors) withholdWeightOfImages(grid, work.obstacles, settings.gravity, fall, work.grid);
    energy.onFaces(EnergyChange::Gravity);

    if (settings.liquid.solveViscosity && settings.liquid.viscosity > 0.0) {
        clock.start(Stage::Viscosity);
        withholdPressure(state, settings, work, dt, fall);
        if (!work.obstacles.empty()) work.onSolids.beforeViscosity(work.grid.faces.velocity);
        report.viscosity = solveViscosity(grid, work.obstacleField, settings.liquid, settings.solver, fall, work.viscosity, work.grid);
        const double bySolids =
            work.obstacles.empty() ? 0.0 : work.onSolids.afterViscosity(grid, work.obstacleField, work.viscosity.system, work.grid);
        giveBack(work.viscosity.withheld, work.grid.faces.velocity);
        energy.viscosity(bySolids);
    }
    work.grid.unpressed = work.grid.faces.velocity;
}

/// The pressure, which moves aside what is where sources have pressed liquid in.
void project(State& state, const Settings& settings, Workspace& work, double dt, StepReport& report, EnergyBook& energy)
{
    const BlockGrid& grid = state.grid;
    findInflowCells(grid, work.grid, work.emission.inflows, work.packing, dt, work.inflow);
    report.pressure = solvePressure(grid, work.obstacleField, settings.solver, work.inflow, work.pressure, work.grid, state.pressure);
    if (work.emission.inflows.empty()) return;
    report.inflowWork = inflowWork(grid, work.inflow, state.pressure, dt);
    energy.pressedIn(report.inflowWork);
    for (const Inflow& inflow : work.emission.inflows) {
        const bool isShut = isShutIn(inflow.source, work.inflow, grid, work.grid, work.pressure.solver.components());
        state.memory.sources[inflow.source].isShut = isShut ? 1.0 : 0.0;
    }
}

/// Bring the liquid back to its volume.
void correct(State& state, const Settings& settings, Workspace& work, bool isMixed, StepReport& report)
{
    const BlockGrid& grid = state.grid;
    const double strength = std::min(kLargestShare, settings.liquid.volume.rate * state.uncorrected);
    report.volume = correctVolume(grid, work.obstacleField, work.pressure, settings.gravity, work.grid, strength, settings.solver,
                                  work.volume);
    state.uncorrected = 0.0;
    findUnheldFaces(grid, work.obstacleField, work.free);
    if (isMixed) work.coupling->mixture.clearShared(work.free.unheld);
    takeMeans(grid, work.pressure, work.grid, work.volume.displacement, work.free, work.volume.displacement);
}

/// Pressure and surface tension leave free liquid, and fabric that it carries along, the momentum that they have.
/// @param velocity  of the faces, after both
void keepMomentum(const Settings& settings, const BlockGrid& grid, bool isMixed, Workspace& work, BlockArray<double, 3>& velocity)
{
    BlockArray<double, 3>& change = work.free.change;
    change.resize(grid.count());
    parallelFor(grid.count(), 4, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        const double *now = velocity.block(b), *before = work.grid.unpressed.block(b);
        double* by = change.block(b);
        for (std::size_t i = 0; i < BlockArray<double, 3>::kStride; ++i) by[i] = now[i] - before[i];
    });
    findUnheldFaces(grid, work.obstacleField, work.free);
    const bool carries = isMixed && settings.coupling.pressureOnFabric;
    if (carries) work.coupling->mixture.toPairs(work.grid, change);
    else if (isMixed) work.coupling->mixture.clearShared(work.free.unheld);
    takeMeans(grid, work.pressure, work.grid, change, work.free, velocity);
    if (carries) work.coupling->mixture.fromPairs(work.grid);
}

/// May what holds liquid move?
bool isFrameMoving(bool isMixed, const Workspace& work) { return isMixed || work.obstacles.anyMoving(); }

/// Cells of the liquid that solids and fabric hold, and how fast these move.
void findHeld(const State& state, bool isMixed, Workspace& work)
{
    findHeldCells(state.grid, work.pressure, work.grid, work.free);
    if (!isFrameMoving(isMixed, work)) return;
    const Vec3 ofFabric = isMixed ? meanVelocity(work.coupling->fabric, state.fabric) : Vec3(Vec3::Zero());
    findFrames(state.grid, work.obstacleField, work.pressure, work.grid, ofFabric, work.free);
}

/// Surface tension and pressure on the velocities of the faces, and what brings the liquid back to its volume.
void press(State& state, const Settings& settings, Workspace& work, double dt, const LiquidPlan& plan, StepReport& report, StageClock& clock,
           EnergyBook& energy)
{
    const BlockGrid& grid = state.grid;
    clock.start(Stage::Cells);
    findLiquidCells(grid, work.obstacleField, settings.liquid.full, work.grid);
    findSurface(grid, work.obstacleField, work.grid);

    const bool isTense = feelsSurfaceTension(settings.liquid);
    if (isTense) {
        clock.start(Stage::SurfaceTension);
        findSurfaceSteps(grid, work.obstacleField, settings.liquid, work.grid, work.surfaceTension);
    }

    clock.start(Stage::Pressure);
    findPressureFaces(grid, work.obstacleField, settings.liquid, dt, work.grid, work.pressure);
    if (plan.isMixed) work.coupling->mixture.blend(work.obstacleField, work.grid, work.pressure.coefficient);
    preparePressure(grid, work.grid, work.pressure);
    const double fall = fallTime(settings.time, state, dt, plan.meetsFabric);
    if (levelHeldWeight(state, settings, work, fall, plan.isMixed, &work.onSolids)) energy.onFaces(EnergyChange::Gravity);
    if (isTense) {
        applySurfaceSteps(grid, work.obstacleField, work.pressure, fall / dt, work.surfaceTension, work.grid);
        energy.surfaceTension(plan.isMixed);
    }
    if (!work.obstacles.empty()) work.gainAtWalls.begin(work.obstacleField, work.grid.faces.velocity);
    project(state, settings, work, dt, report, energy);

    if (plan.corrects) {
        clock.start(Stage::Volume);
        correct(state, settings, work, plan.isMixed, report);
        clock.start(Stage::Pressure);
    }
    keepMomentum(settings, grid, plan.isMixed, work, work.grid.faces.velocity);
    if (!work.obstacles.empty()) work.gainAtWalls.bound(work.obstacleField, work.grid.faces.velocity);
}

/// Does anything go by the liquid that vertices see?
bool asksForLiquidAround(const CouplingSettings& coupling)
{
    return coupling.capture.rate > 0.0 || (coupling.drag != DragLaw::Off && coupling.dragFraction == DragFraction::Fabric);
}

/// What solids get of the liquid on its faces, now that these have the velocities that particles will read.
void tellSolids(const State& state, const Settings& settings, double dt, const LiquidPlan& plan, const GatherSettings& gather, Workspace& work)
{
    if (plan.isMixed) {
        work.onSolids.meetFabric();
        work.coupling->mixture.forEachImpulseTaken(
            [&](int b, int a, int c, double impulse) { work.onSolids.fabricTook(b, a, c, impulse); });
    }
    const LiquidOnSolids::Outcome outcome{.velocity = plan.reflects ? work.reflection.velocity : work.grid.faces.velocity,
                                          .liquid = work.grid,
                                          .system = work.pressure,
                                          .pressure = state.pressure,
                                          .again = plan.reflects ? &work.reflection.potential : nullptr,
                                          .flipVelocity = gather.flipVelocity,
                                          .flipRatio = gather.flipRatio,
                                          .perPressure = dt * work.grid.fullMass / (settings.liquid.density * state.grid.dx),
                                          .fall = fallTime(settings.time, state, dt, plan.meetsFabric) * settings.gravity};
    work.onSolids.finish(state.grid, work.obstacleField, outcome);
}

}  // namespace

double fallTime(const TimeSettings& time, const State& state, double dt, bool meetsFabric)
{
    const bool isFirst = state.lastDt == 0.0;
    return time.reflects() && (isFirst || !meetsFabric) ? 0.5 * (state.lastDt + dt) : dt;
}

Vec3 meanGravity(const Settings& settings, const State& state, double dt, bool meetsFabric)
{
    return meetsFabric ? Vec3(settings.gravity * (fallTime(settings.time, state, dt, true) / dt)) : settings.gravity;
}

LiquidPlan startLiquid(State& state, const Scene& scene, Workspace& work, double dt, bool reflects, StepReport& report, StageClock& clock,
                       EnergyBook& energy)
{
    const Settings& settings = scene.settings;
    LiquidPlan plan;
    plan.flips = settings.transfer.method == TransferMethod::Flip;
    plan.reflects = reflects;
    const bool keepsAdvected = plan.flips || plan.reflects;
    LiquidParticles& particles = state.liquid;
    BlockGrid& grid = state.grid;

    // Particles are outside the solids where these are when the step begins.
    work.obstacles.startAt(state.time, state.time + dt);

    clock.start(Stage::Sort);
    sortParticles(particles, grid, scene.domain ? &*scene.domain : nullptr, work.order, state.ledger);
    work.momentum.left(state);
    energy.sorted();
    carryPressureOver(grid, work.order, work.oldPressure, state.pressure);
    work.grid.resize(grid.count(), keepsAdvected);
    work.grid.fullMass = work.packing * settings.liquid.density * grid.dx * grid.dx * grid.dx;

    if (!work.obstacles.empty()) clock.start(Stage::Obstacles);
    work.obstacleField.update(grid, work.order.previous, work.obstacles, wallsMirror(settings.liquid.wallFriction));

    plan.meetsFabric = work.coupling && reachesLiquid(grid, state.fabric);
    if (plan.meetsFabric) {
        clock.start(Stage::Capture);
        work.coupling->vertices.sort(grid, state.fabric);
        plan.meetsFabric = !work.coupling->vertices.empty() &&
                           (!asksForLiquidAround(settings.coupling) ||
                            work.coupling->around.find(grid, work.order, particles, work.obstacleField, work.coupling->vertices));
        if (plan.meetsFabric) {
            const ExchangeWatch watch(work.coupling->fabric, state, &work.order);
            work.coupling->twist.note(work.coupling->fabric, state.fabric);
            report.capturedMass = work.coupling->capture.capture(dt, grid, work.order, work.coupling->vertices, particles, state.fabric);
            work.coupling->twist.keep(work.coupling->fabric, state.fabric);
            watch.expectKept(work.coupling->capture.toPins());
            work.momentum.exchanged(state, work.coupling->capture.toPinsByVertex());
            energy.taken(EnergyChange::Capture);
        }
    }

    state.unrelaxed += dt;
    state.uncorrected += dt;
    plan.relaxes = work.relaxReach > 0.0 && isDue(settings.liquid.relax.rate, state.unrelaxed, dt);
    plan.corrects = isDue(settings.liquid.volume.rate, state.uncorrected, dt);
    if (plan.relaxes) {
        clock.start(Stage::Relax);
        relaxationDisplacements(particles, work.order, grid, settings.liquid.relax.rate, work.relaxReach, state.unrelaxed, work.relax,
                                work.displacement);
        keepRelaxationFromLifting(work.order, grid, work.obstacleField, work.obstacles, settings.gravity, work.relaxReach, particles,
                                  work.displacement);
        state.unrelaxed = 0.0;
    }

    liquidToGrid(state, settings, work, dt, fallTime(settings.time, state, dt, plan.meetsFabric), keepsAdvected, report, clock, energy);

    if (plan.meetsFabric) {
        if (work.gridFabric) work.gridFabric->spread(state.fabric, clock);
        clock.start(Stage::Mixture);
        const std::optional<FabricFaces> faces = facesOf(work);
        // To reflect some faces of a liquid only would make momentum; those with fabric are not reflected (liquid/README.md, Reflection).
        plan.reflects = false;
        plan.isMixed = work.coupling->mixture.find(grid, work.obstacleField, meanGravity(settings, state, dt, true), dt, state.fabric,
                                                   faces ? &*faces : nullptr, work.grid);
    }

    press(state, settings, work, dt, plan, report, clock, energy);
    return plan;
}

void finishLiquid(State& state, const Scene& scene, Workspace& work, double dt, const LiquidPlan& plan, StepReport& report, StageClock& clock,
                  EnergyBook& energy)
{
    const Settings& settings = scene.settings;
    LiquidParticles& particles = state.liquid;
    BlockGrid& grid = state.grid;
    clock.start(Stage::Pressure);
    if (plan.isMixed) work.coupling->mixture.takeDisplaced(work.grid);
    if (settings.time.reflects()) findHeld(state, plan.isMixed, work);
    if (plan.reflects) {
        clock.start(Stage::Reflection);
        report.reflection = reflect(grid, work.obstacleField, settings.solver, work.inflow, work.pressure, work.grid, work.reflection);
        keepMomentum(settings, grid, plan.isMixed, work, work.reflection.velocity);
        if (!work.obstacles.empty()) work.gainAtWalls.bound(work.obstacleField, work.reflection.velocity);
        energy.reflected(dt);
    }
    GatherSettings gather = gatherSettings(scene, work, dt);
    if (!work.obstacles.empty()) {
        clock.start(Stage::Walls);
        finishAtWalls(grid, settings.liquid, plan, work);
        energy.walls(plan.reflects ? work.reflection.velocity : work.grid.faces.velocity,
                     fallTime(settings.time, state, dt, plan.meetsFabric) * settings.gravity, gather.flipRatio);
    }

    clock.start(Stage::GridToParticles);
    if (plan.relaxes) gather.displacement = work.displacement.data();
    if (plan.corrects) gather.faceDisplacement = &work.volume.displacement;
    if (!work.obstacles.empty()) tellSolids(state, settings, dt, plan, gather, work);
    if (work.kept) work.kept->keepModes(particles, plan.flips);
    if (!work.obstacles.empty()) keepPlaces(particles, work.places);
    if (plan.reflects) gather.reflected = &work.reflection.velocity;
    if (settings.time.reflects()) gather.atMidpoint = &work.free.held;
    if (settings.time.reflects() && isFrameMoving(plan.isMixed, work)) gather.frames = work.free.frames.data();
    GatherSums sums = facesToParticles(work.grid.faces, work.order, grid, gather, work.gather, particles);
    PushedOut pushed;
    const double held = std::sqrt(sums.maxSpeedSquared), along = std::sqrt(sums.maxPathSquared);
    report.maxSpeed = plan.reflects ? along : held;
    if (!work.obstacles.empty()) {
        work.obstacles.moveTo(state.time, state.time + dt);
        const double farthest = std::max(held, along) * dt + (plan.relaxes ? work.relaxReach : 0.0) +
                                (plan.corrects ? std::sqrt(3.0) * kLargestCorrection * grid.dx : 0.0);
        pushed = pushOutOfObstacles(work.order, grid, work.obstacleField, work.obstacles, farthest, &work.places, particles,
                                     work.pushedSolids);
        sums.kinetic -= pushed.lost;
    }
    const WeightSums weights = weightSums(particles, settings.gravity);
    const Vec3 weight = weights.mass * fallTime(settings.time, state, dt, plan.meetsFabric) * settings.gravity;
    work.momentum.liquidMoved(sums.momentum, weight, work.onSolids, work.pushedSolids);
    energy.solidsGave();
    energy.toParticles(dt, pushed);
    report.energies = {sums.kinetic, plan.flips ? 0.0 : sums.modal, weights.potential, {}};
    report.liquidMass = weights.mass;
    report.particles = particles.count;
    report.blocks = grid.count();
    report.liquidCells = countLiquidCells(grid, work.grid);
    if (!std::isfinite(held) || !std::isfinite(report.energies.total())) report.failure = "velocities are not finite";
}

}  // namespace sim
