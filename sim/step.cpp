#include "sim/step.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/liquid/energy.h"
#include "sim/liquid/face_velocity.h"
#include "sim/liquid/level_set.h"
#include "sim/liquid/push_out.h"
#include "sim/liquid/walls.h"
#include "sim/particles/emit.h"
#include "sim/transfer/scatter_affine.h"

#include <cmath>

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
        settings.flipVelocity = &work.grid.flipVelocity;
    }
    if (work.displaces) settings.displacement = work.displacement.data();
    if (work.grid.hasGaps) settings.gaps = &work.grid.gaps;
    return settings;
}

/// Is it time to push crowded particles apart? Several short steps share one relaxation, as long as it stays gentle.
bool isRelaxationDue(const State& state, const RelaxSettings& relax, double reach, double dt)
{
    constexpr double kRoundOff = 1.0 + 1.0e-9;  // eight steps of 2e-4 s at the default rate make exactly the strength
    return reach > 0.0 && relax.rate * (state.unrelaxed + dt) > kRelaxStrength * kRoundOff;
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

std::size_t countLiquidCells(const BlockGrid& grid, const LiquidGrid& liquid)
{
    return parallelReduce(
        grid.count(), std::size_t{0},
        [&](std::size_t b) {
            const double* phi = liquid.levelSet.block(static_cast<int>(b));
            return static_cast<std::size_t>(std::count_if(phi, phi + kBlockCells, [](double v) { return v < 0.0; }));
        },
        std::plus<>());
}

/// Fill the faces around the liquid that its particles will read.
void fillFaces(const BlockGrid& grid, double friction, Workspace& work, BlockBits<3>& valid, BlockArray<double, 3>& velocity)
{
    extrapolate(grid, work.extrapolation, valid, velocity);
    if (!work.obstacles.empty())
        applyWalls(grid, work.obstacleField, work.obstacles, friction, work.extrapolation, valid, velocity, work.grid);
}

}  // namespace

StepReport step(State& state, const Scene& scene, Workspace& work, double dt)
{
    const Settings& settings = scene.settings;
    const bool flip = settings.transfer.method == TransferMethod::Flip;
    LiquidParticles& particles = state.liquid;
    BlockGrid& grid = state.grid;
    StepReport report;
    report.dt = dt;
    StageClock clock(report);

    work.obstacles.moveTo(state.time, state.time + dt);

    if (emits(scene, state, state.time, state.time + dt)) {
        clock.start(Stage::Emit);
        emitLiquid(scene, state, state.time, state.time + dt);
    }

    clock.start(Stage::Sort);
    sortParticles(particles, grid, scene.domain ? &*scene.domain : nullptr, work.order, state.ledger);
    carryPressureOver(grid, work.order, work.oldPressure, state.pressure);
    work.grid.resize(grid.count(), flip);

    if (!work.obstacles.empty()) clock.start(Stage::Obstacles);
    work.obstacleField.update(grid, work.order.previous, work.obstacles);

    state.unrelaxed += dt;
    work.displaces = isRelaxationDue(state, settings.liquid.relax, work.relaxReach, dt);
    if (work.displaces) {
        clock.start(Stage::Relax);
        relaxationDisplacements(particles, work.order, grid, settings.liquid.relax.rate, work.relaxReach, state.unrelaxed, work.relax,
                                work.displacement);
        state.unrelaxed = 0.0;
    }

    clock.start(Stage::ParticlesToGrid);
    if (differsFromTranslation(settings.transfer.xi, settings.transfer.modeCount()))
        particlesToFacesAffine(particles, work.order, grid, settings.transfer.xi, state.lastDt, work.grid.faces);
    else particlesToFaces(particles, work.order, grid, work.scatter, work.grid.faces);
    if (settings.liquid.wallFriction < 1.0) foldAtWalls(grid, work.obstacles, work.grid.faces);
    divideAndAddGravity(grid, settings.gravity, dt, flip, work.grid);

    clock.start(Stage::LevelSet);
    levelSetFromParticles(particles, work.order, grid, work.grid);
    classifyCells(grid, work.obstacleField, settings.liquid.full, work.grid);

    clock.start(Stage::Pressure);
    report.pressure = projectPressure(grid, work.obstacleField, settings.liquid, settings.solver, dt, work.pressure, work.grid, state.pressure);

    clock.start(Stage::Extrapolate);
    if (flip) {
        work.grid.flipValid = work.grid.faces.valid;
        fillFaces(grid, settings.liquid.wallFriction, work, work.grid.flipValid, work.grid.flipVelocity);
    }
    fillFaces(grid, settings.liquid.wallFriction, work, work.grid.faces.valid, work.grid.faces.velocity);
    findGaps(grid, work.order, work.grid);

    clock.start(Stage::GridToParticles);
    const GatherSums sums = facesToParticles(work.grid.faces, work.order, grid, gatherSettings(scene, work, dt), work.gather, particles);
    report.maxSpeed = std::sqrt(sums.maxSpeedSquared);
    if (!work.obstacles.empty())
        pushOutOfObstacles(work.order, grid, work.obstacleField, work.obstacles, report.maxSpeed * dt + work.relaxReach, particles);

    state.time += dt;
    ++state.step;
    state.lastDt = dt;

    const WeightSums weights = weightSums(particles, settings.gravity);
    report.energies = {sums.kinetic, flip ? 0.0 : sums.modal, weights.potential};
    report.liquidMass = weights.mass;
    report.particles = particles.count;
    report.blocks = grid.count();
    report.liquidCells = countLiquidCells(grid, work.grid);
    if (!std::isfinite(report.maxSpeed) || !std::isfinite(report.energies.total())) report.failure = "velocities are not finite";
    return report;
}

double cflNumber(const Settings& settings, double maxSpeed, double dt)
{
    return dt * (maxSpeed + std::sqrt(settings.cell * settings.gravity.norm())) / settings.cell;
}

double chooseTimeStep(const Settings& settings, double maxSpeed)
{
    const TimeSettings& time = settings.time;
    const double perCfl = 1.0 / cflNumber(settings, maxSpeed, 1.0);
    const double bound = time.mode == TimeMode::Fixed ? time.maxCflLiquid : std::min(time.cfl, time.maxCflLiquid);
    return std::min(time.dt, bound * perCfl);
}

}  // namespace sim
