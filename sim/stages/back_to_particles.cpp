#include "sim/core/parallel.h"
#include "sim/liquid/cells.h"
#include "sim/liquid/energy.h"
#include "sim/liquid/push_out.h"
#include "sim/liquid/walls.h"
#include "sim/stages/stages.h"

#include <cmath>

namespace sim {

namespace {

/// What is kept over one step of dt [s] of which a share is kept over dampingDt [-].
double keptOver(double dt, double share, const TransferSettings& transfer)
{
    return transfer.dampingPerStep ? share : std::pow(share, dt / transfer.dampingDt);
}

/// Share of their own velocities that particles keep [-].
double flipRatio(const StepContext& c) { return c.isFlip() ? keptOver(c.dt, c.settings().transfer.flipRatio, c.settings().transfer) : 0.0; }

/// Velocities of the faces that particles read.
BlockArray<double, 3>& velocityRead(StepContext& c) { return c.plan.reflects ? c.work.reflection.velocity : c.work.grid.faces.velocity; }

GatherSettings gatherSettings(const StepContext& c)
{
    const TransferSettings& transfer = c.settings().transfer;
    const Workspace& work = c.work;
    GatherSettings settings;
    settings.dt = c.dt;
    settings.modes = transfer.modeCount();
    const bool damps = transfer.method == TransferMethod::Apic || (transfer.method == TransferMethod::PolyPic && transfer.dampModes);
    settings.keep = damps ? keptOver(c.dt, 1.0 - transfer.affineDamping, transfer) : 1.0;
    if (c.isFlip()) {
        settings.flipRatio = flipRatio(c);
        settings.flipVelocity = &work.grid.advected;
    }
    if (settings.modes > kModesAtSurface) settings.manyModes = &work.grid.deep;
    if (c.plan.relaxes) settings.displacement = work.displacement.data();
    if (c.plan.correctsVolume) settings.faceDisplacement = &work.volume.displacement;
    if (c.plan.reflects) settings.reflected = &work.reflection.velocity;
    if (c.settings().time.reflects()) settings.atMidpoint = &work.free.held;
    if (c.settings().time.reflects() && c.isFrameMoving()) settings.frames = work.free.frames.data();
    return settings;
}

/// Keep where the particles are before they move.
void keepPlaces(const LiquidParticles& particles, std::array<AlignedArray<double>, kAxes>& places)
{
    for (int a = 0; a < kAxes; ++a) {
        places[a].resize(particles.x[a].size());
        parallelFor(particles.count, 4096, [&](std::size_t p) { places[a][p] = particles.x[a][p]; });
    }
}

/// Farthest that the correction of the volume has moved a particle [cm]: along each axis their displacements are means of those of faces.
double farthestCorrected(const BlockArray<double, 3>& displacement, int blocks)
{
    return std::sqrt(3.0) * parallelMax(blocks, [&](std::size_t b) {
               const double* faces = displacement.block(static_cast<int>(b));
               Pack largest = broadcast(0.0);
               for (int i = 0; i < kAxes * kBlockCells; i += kLanes) largest = maxPack(largest, absPack(loadPack(faces + i)));
               double most = 0.0;
               for (int l = 0; l < kLanes; ++l) most = std::max(most, largest[l]);
               return most;
           });
}

/// @param fastest  speed at which particles may have moved [cm/s]
PushOutTotals pushOut(StepContext& c, double fastest)
{
    if (!c.hasObstacles()) return {};
    Workspace& work = c.work;
    work.obstacles.moveTo(c.state.time, c.state.time + c.dt);
    const double farthest = fastest * c.dt + (c.plan.relaxes ? work.relaxReach : 0.0) +
                            (c.plan.correctsVolume ? farthestCorrected(work.volume.displacement, c.state.grid.count()) : 0.0);
    return pushOutOfObstacles(work.order, c.cut(), farthest, &work.places, c.state.liquid, work.pushedSolids);
}

/// Openings give momentum to the liquid, which near solids is not from these.
void bookOpenings(StepContext& c, double perPressure)
{
    Workspace& work = c.work;
    if (work.openings.empty() || !work.momentum.isOpen()) return;
    std::optional<LiquidOnSolids::Levelling> told;
    if (c.hasObstacles()) told = work.onSolids.meetLevelling();
    const BlockArray<double>* again = c.plan.reflects ? &work.reflection.potential : nullptr;
    const Openings::Outcome outcome{velocityRead(c), work.grid, c.state.pressure, again, perPressure};
    work.momentum.pushedIn(work.openings.impulse(c.cut(), outcome, told ? &*told : nullptr));
}

/// What the mean velocity of the liquid at the end of the step is beyond that of its particles, which with the integrator reflected is of halfway
/// through the step [cm/s]: half a step of weight, and of what acted against it. Of that it is at most as much as of weight, since
/// what stops liquid that hits something is over within a step. Between two steps of which the first reflects it is not known, and 0.
/// @param push  acceleration of the liquid by all but weight in the step [cm/s^2]
Vec3 changeSinceMidstep(const StepContext& c, const Vec3& push)
{
    if (!c.settings().time.reflects() || c.plan.reflects) return Vec3::Zero();
    const double weight = c.settings().gravity.norm(), size = push.norm();
    return 0.5 * c.dt * (c.settings().gravity + (size > weight ? weight / size : 1.0) * push);
}

}  // namespace

void findHeld(StepContext& c)
{
    if (!c.plan.isWet || !c.settings().time.reflects()) return;
    const StageScope scope(c.clock, Stage::Pressure);
    Workspace& work = c.work;
    findHeldCells(c.state.grid, *c.plan.heldBodies, work.free);
    if (!c.isFrameMoving()) return;
    const Vec3 ofFabric = c.plan.isMixed() ? meanVelocity(work.coupling->fabric, c.state.fabric) : Vec3(Vec3::Zero());
    findFrames(c.cut(), *c.plan.heldBodies, ofFabric, work.free);
}

void applyWalls(StepContext& c)
{
    if (!c.plan.isWet || !c.hasObstacles()) return;
    const StageScope scope(c.clock, Stage::Walls);
    Workspace& work = c.work;
    LiquidGrid& liquid = work.grid;
    const LiquidSettings& settings = c.settings().liquid;
    const auto apply = [&](BlockBits<3>& valid, BlockArray<double, 3>& velocity) {
        applyWalls(c.cut(), settings.wallFriction, settings.solveViscosity, work.wallFaces, valid, velocity);
    };
    if (c.isFlip()) {
        liquid.advectedValid = liquid.faces.valid;
        apply(liquid.advectedValid, liquid.advected);
    }
    if (c.plan.reflects) apply(work.reflection.valid, work.reflection.velocity);
    apply(liquid.faces.valid, liquid.faces.velocity);
    c.energy.walls(velocityRead(c), c.fallTime() * c.settings().gravity, flipRatio(c));
}

void pushSolids(StepContext& c)
{
    if (!c.plan.isWet) return;
    const double perPressure = c.dt * c.work.grid.fullMass / (c.settings().liquid.density * c.state.grid.dx);
    bookOpenings(c, perPressure);
    if (!c.hasObstacles()) return;
    const StageScope scope(c.clock, Stage::GridToParticles);
    Workspace& work = c.work;
    if (c.plan.separatedPhases) {
        const LiquidOnSolids::Exchange exchange = work.onSolids.meetFabric();
        work.coupling->mixture.forEachImpulseTaken(
            *c.plan.separatedPhases, [&](int block, int axis, int cell, double impulse) { exchange.fabricTook(block, axis, cell, impulse); });
    }
    const LiquidOnSolids::Outcome outcome{.velocity = velocityRead(c),
                                          .liquid = work.grid,
                                          .system = *c.plan.pressure,
                                          .pressure = c.state.pressure,
                                          .again = c.plan.reflects ? &work.reflection.potential : nullptr,
                                          .flipVelocity = c.isFlip() ? &work.grid.advected : nullptr,
                                          .flipRatio = flipRatio(c),
                                          .perPressure = perPressure,
                                          .fall = c.fallTime() * c.settings().gravity};
    work.onSolids.finish(c.cut(), outcome);
}

void gridToParticles(StepContext& c)
{
    if (!c.plan.isWet) return;
    const StageScope scope(c.clock, Stage::GridToParticles);
    Workspace& work = c.work;
    LiquidParticles& particles = c.state.liquid;
    const BlockGrid& grid = c.state.grid;
    if (c.hasObstacles()) keepPlaces(particles, work.places);
    const auto gather = [&] { return facesToParticles(work.grid.faces, work.order, grid, gatherSettings(c), work.gather, particles); };
    GatherSums sums = work.backup ? work.backup->rewriteModes(particles, c.isFlip(), gather) : gather();
    const double held = std::sqrt(sums.maxSpeedSquared), along = std::sqrt(sums.maxPathSquared);
    const PushOutTotals pushed = pushOut(c, std::max(held, along));
    sums.kinetic -= pushed.lost;
    const WeightSums weights = weightSums(particles, c.settings().gravity);
    c.report.maxSpeed = c.plan.reflects ? along : held;
    c.report.energies = {{.kinetic = sums.kinetic, .modal = c.isFlip() ? 0.0 : sums.modal, .potential = weights.potential}, {}};
    if (c.correctsStrain() && !c.isFlip()) c.report.energies.storeStrain(sums.strain);
    c.report.liquidMass = weights.mass;
    c.report.blocks = grid.count();
    c.report.liquidCells = countLiquidCells(grid, *c.plan.surfaceCells);
    if (!std::isfinite(held) || !std::isfinite(c.report.energies.total())) c.report.failure = "velocities are not finite";
    const Vec3 weight = weights.mass * c.fallTime() * c.settings().gravity;
    const Vec3 butWeight = work.momentum.liquidMoved(sums.momentum, weight, work.onSolids, work.pushedSolids);
    c.state.memory.sinceMidstep = weights.mass > 0.0 ? changeSinceMidstep(c, butWeight / (weights.mass * c.dt)) : Vec3::Zero();
    c.energy.bookSolidsWork();
    c.energy.toParticles(c.dt, pushed);
}

}  // namespace sim
