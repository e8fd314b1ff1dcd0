#include "sim/simulation.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"
#include "sim/fabric/prescribed_fabric.h"
#include "sim/fabric/vertex/vertex_solver.h"
#include "sim/liquid/energy.h"
#include "sim/particles/velocity_modes.h"
#include "sim/scene/surface_order.h"
#include "sim/sources/emit.h"
#include "sim/sources/seed.h"
#include "sim/step.h"
#include "sim/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace sim {

namespace {

/// Reach of the relaxation: a little more than the spacing of the finest source (particles/README.md, Relaxation), at most a cell [cm].
double relaxReach(const Scene& scene)
{
    const RelaxSettings& relax = scene.settings.liquid.relax;
    if (relax.rate == 0.0 || scene.sources.empty()) return 0.0;
    double radius = std::numeric_limits<double>::infinity();
    for (const SourceSettings& source : scene.sources) radius = std::min(radius, nominalRadius(source.fill, scene.settings.cell));
    return std::min(relax.range * radius, scene.settings.cell);
}

/// Pitch of the source with the fewest particles, or of a lattice by default where there is none [cells].
double pitchOfSources(const Scene& scene)
{
    double pitch = 0.0;
    for (const SourceSettings& source : scene.sources)
        pitch = std::max(pitch, particleSpacing(source.fill, scene.settings.cell) / scene.settings.cell);
    return pitch > 0.0 ? pitch : particleSpacing(FillSettings(), 1.0);
}

/// Mass of a particle that fabric lets go: like those of the first source [g].
double nominalMass(const Scene& scene)
{
    const FillSettings fill = scene.sources.empty() ? FillSettings() : scene.sources[0].fill;
    return scene.settings.liquid.density * packingOf(fill.pattern) * std::pow(particleSpacing(fill, scene.settings.cell), 3);
}

double fastestOf(const FabricState& fabric)
{
    return parallelMax(fabric.v.size(), [&](std::size_t v) { return fabric.v[v].norm(); });
}

constexpr int kMostRejectedSteps = 10;   ///< halvings until a run gives up: to a thousandth of the step
constexpr double kSecondIsFaster = 1.5;  ///< cells that the second of two steps may cross relative to time.cfl [-]
constexpr double kGrowth = 1.2;          ///< growth of the longest step allowed, from each good one to the next, after one was rejected

double fastest(const LiquidParticles& particles)
{
    return parallelMax(particles.count, [&](std::size_t p) { return particles.velocity(p).norm(); });
}

}  // namespace

Simulation::Simulation(Scene scene) : scene_(std::move(scene)), fabric_(assembleFabric(scene_.fabrics))
{
    const Settings& settings = scene_.settings;
    state_.time = settings.time.start;
    state_.grid.dx = settings.cell;
    state_.liquid.modeCount = storedModes(settings.transfer.modeCount());
    state_.emittedVolume.assign(scene_.sources.size(), 0.0);
    state_.fabric = initialState(fabric_, scene_.fabrics, settings.liquid.density);
    if (settings.fabric.solver == FabricSolver::Off) std::ranges::fill(state_.fabric.v, Vec3::Zero());
    state_.ledger.emittedMass = std::accumulate(state_.fabric.absorbed.begin(), state_.fabric.absorbed.end(), 0.0);
    emitLiquid(scene_, state_, state_.time, state_.time, work_.emission);
    prepareWorkspace();
    begin();
}

Simulation::Simulation(Scene scene, State state) : scene_(std::move(scene)), fabric_(assembleFabric(scene_.fabrics)), state_(std::move(state))
{
    SIM_CHECK(state_.grid.dx == scene_.settings.cell && state_.emittedVolume.size() == scene_.sources.size());
    SIM_CHECK(state_.fabric.x.size() == fabric_.vertexCount());
    if (const SettingsChange* last = lastChange(0, state_.step)) applySettings(*last);
    SIM_CHECK(state_.liquid.modeCount == storedModes(scene_.settings.transfer.modeCount()));
    changedUpTo_ = state_.step;
    prepareWorkspace();
}

/// The last one for a step behind `after`, up to `upTo`; nullptr if there is none.
const SettingsChange* Simulation::lastChange(std::int64_t after, std::int64_t upTo) const
{
    const SettingsChange* last = nullptr;
    for (const SettingsChange& change : scene_.changes)
        if (change.step > after && change.step <= upTo) last = &change;
    return last;
}

void Simulation::applySettings(const SettingsChange& change)
{
    scene_.settings = change.settings;
    scene_.materials = change.materials;
    for (FabricPiece& piece : scene_.fabrics)
        for (const NamedMaterial& named : change.materials)
            if (named.name == piece.materialName) piece.material = named.material;
    fabric_ = assembleFabric(scene_.fabrics);
}

/// What the next step is to be taken with. Everything but the state is built anew, as when a run is gone on with.
void Simulation::applyChanges()
{
    const SettingsChange* change = lastChange(changedUpTo_, state_.step + 1);
    changedUpTo_ = state_.step + 1;
    if (!change) return;
    const bool booksEnergy = work_.booksEnergy;
    work_ = Workspace();
    applySettings(*change);
    state_.liquid.changeModes(storedModes(scene_.settings.transfer.modeCount()));
    prepareWorkspace();
    if (booksEnergy) bookEnergy();
    state_.memory.longest = std::numeric_limits<double>::infinity();
    begin();
}

void Simulation::setChanges(std::vector<SettingsChange> changes)
{
    scene_.changes = std::move(changes);
    changedUpTo_ = state_.step;
}

void Simulation::prepareWorkspace()
{
    check_.emplace(scene_, fabric_);
    if (scene_.settings.time.mode == TimeMode::Adaptive) work_.backup = std::make_unique<StateBackup>();
    for (const ObstacleSettings& obstacle : scene_.obstacles) work_.obstacles.add(obstacle.shape, obstacle.motion);
    work_.obstacles.moveTo(state_.time, state_.time);
    state_.memory.openings.resize(scene_.openings.size());
    if (!scene_.openings.empty())
        work_.openings.prepare(scene_.openings, scene_.domain->bounds(), work_.obstacles, scene_.settings.cell, scene_.settings.gravity);
    work_.momentum.prepare(scene_, fabric_);
    work_.correctsStrain = correctsStrain(scene_);
    work_.relaxReach = relaxReach(scene_);
    work_.packing = packingOfSources(scene_, state_);
    work_.grid.pitch = pitchOfSources(scene_);
    if (scene_.settings.fabric.solver == FabricSolver::Off) {
        std::ranges::fill(fabric_.pinned, 1);
        std::ranges::fill(state_.fabric.held, Vec3::Ones());
    }
    const bool isWet = std::ranges::any_of(scene_.fabrics, [](const FabricPiece& piece) { return piece.wetness > 0.0; });
    if (!fabric_.empty() && (isWet || !scene_.sources.empty() || !scene_.openings.empty()))
        work_.coupling = std::make_unique<Coupling>(fabric_, scene_.settings, nominalMass(scene_));
    if (!fabric_.empty()) work_.fabric = makeIntegrator();
    if (work_.fabric) work_.fabric->reportForces(work_.momentum.forces());
}

std::unique_ptr<FabricIntegrator> Simulation::makeIntegrator() const
{
    const Settings& settings = scene_.settings;
    switch (settings.fabric.solver) {
        case FabricSolver::Vertex: return std::make_unique<VertexSolver>(fabric_, settings.fabric, scene_.obstacles, cohesion());
        case FabricSolver::Grid: return std::make_unique<GridFabricSolver>(fabric_, settings, scene_.obstacles, work_.coupling != nullptr);
        case FabricSolver::Off: break;
    }
    return std::make_unique<PrescribedFabric>(fabric_, settings.fabric);
}

/// What holds wet fabric, if anything does and there is liquid to wet it.
std::optional<Cohesion> Simulation::cohesion() const
{
    const CohesionSettings& settings = scene_.settings.coupling.cohesion;
    if (!work_.coupling || !(settings.strength > 0.0)) return std::nullopt;
    return Cohesion(fabric_, scene_.settings.liquid, settings);
}

/// Begins from the state as it is: nothing is known of steps before.
void Simulation::begin()
{
    state_.memory.maxSpeed = fastest(state_.liquid);
    StepCheck::start(energies(), state_.memory);
}

void Simulation::bookEnergy()
{
    work_.booksEnergy = true;
    if (work_.fabric) work_.fabric->bookEnergy();
}

Energies Simulation::energies() const
{
    Energies energies{liquidEnergies(state_.liquid, state_.grid, scene_.settings.gravity), {}};
    energies.potential += staggeredPotentialOffset(state_, scene_.settings);
    if (work_.correctsStrain) energies.storeStrain(strainEnergy(state_.liquid, state_.grid));
    if (work_.fabric) energies.fabric = work_.fabric->energies(state_.fabric, scene_.settings.gravity);
    return energies;
}

/// Equal parts of what is left, none beyond the largest; an even number where each first one of two reflects, and the
/// second is as long, unless the liquid has become so fast that it would cross far more cells than the first was to, or
/// break the hard bound.
double Simulation::lengthOfStep(double left, double largest) const
{
    constexpr double kRoundOff = 1.0e-9;  // steps may be longer by that much, so that 4e-3 s in steps of 2e-4 s are 20 and not 21
    const TimeSettings& time = scene_.settings.time;
    const double mostCells = time.mode == TimeMode::Fixed ? time.maxCflLiquid : std::min(kSecondIsFaster * time.cfl, time.maxCflLiquid);
    if (state_.reflected && state_.lastDt <= state_.memory.longest && cflNumber(scene_.settings, state_.memory.maxSpeed, state_.lastDt) <= mostCells)
        return state_.lastDt < left * (1.0 - kRoundOff) ? state_.lastDt : left;
    const double parts = std::max(1.0, std::ceil(left / largest * (1.0 - kRoundOff)));
    return left / (mayReflect(state_, time, work_) ? 2.0 * std::ceil(0.5 * parts) : parts);
}

RunError Simulation::failure(std::string_view stage, const std::string& why) const
{
    return RunError(fmt::format("scene {}, step {}, t = {:.6g} s, stage {}: {}", scene_.name, state_.step + 1, state_.time, stage, why));
}

RunError Simulation::failure(const StepFailure& fault, int halvings, double dt) const
{
    std::string why = fault.what;
    if (halvings > 0) why += fmt::format("; {} halvings of the step to {:.3g} s did not help", halvings, dt);
    if (!fault.remedy.empty()) why += fmt::format("; try {}", fault.remedy);
    return failure(kStageNames[static_cast<int>(fault.stage)], why);
}

double Simulation::chooseLength(double until) const
{
    const double largest = std::min(state_.memory.longest, chooseTimeStep(scene_.settings, state_, state_.memory.maxSpeed)),
                 least = scene_.settings.time.dtMin;
    if (!(largest >= least))
        throw failure(
            "time_step",
            fmt::format("the largest stable step, {:.3g} s, is below time.dt_min = {:.3g} s: liquid moves at {:.3g} cm/s, fabric at {:.3g} cm/s",
                        largest, least, state_.memory.maxSpeed, fastestOf(state_.fabric)));
    return lengthOfStep(until - state_.time, largest);
}

/// One step of dt [s], and what is wrong with it.
std::optional<StepFailure> Simulation::tryStep(double dt, StepReport& report)
{
    try {
        report = sim::step(state_, scene_, work_, dt);
    } catch (const RunError& error) {
        return StepFailure{work_.failedStage, error.what(), ""};
    }
    if (auto fault = check_->violatedInvariant(state_, report)) return fault;
    return work_.backup ? check_->rejectionReason(state_, report) : std::nullopt;
}

/// The step is good.
void Simulation::accept(const StepReport& report)
{
    state_.memory.maxSpeed = report.maxSpeed;
    StepCheck::accept(report, state_.memory);
    state_.memory.longest *= kGrowth;
    if (state_.memory.longest >= scene_.settings.time.dt) state_.memory.longest = std::numeric_limits<double>::infinity();
}

StepReport Simulation::step(double until)
{
    using Clock = std::chrono::steady_clock;
    const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
    double keeping = 0.0, lost = 0.0;
    applyChanges();
    for (int rejectedSteps = 0;; ++rejectedSteps) {
        const double left = until - state_.time, dt = chooseLength(until);
        const double cfl = hasLiquid(state_) ? cflNumber(scene_.settings, state_.memory.maxSpeed, dt) : 0.0;
        const auto begin = Clock::now();
        std::optional<StateBackup::Kept> backup;
        if (work_.backup) backup = work_.backup->keep(state_);
        const auto kept = Clock::now();
        keeping += seconds(kept - begin);

        StepReport report;
        const std::optional<StepFailure> fault = tryStep(dt, report);
        if (!fault) {
            if (dt == left) state_.time = until;
            report.cfl = cfl;
            report.rejectedSteps = rejectedSteps;
            if (backup) report.charge(Stage::Backup, keeping);
            if (rejectedSteps > 0) report.charge(Stage::Rejected, lost);
            accept(report);
            return report;
        }
        if (!backup) throw failure(*fault, 0, dt);
        work_.backup->restore(*backup, state_);
        work_.obstacleField = ObstacleField();  // it is that of the blocks that the bad step had
        state_.memory.longest = 0.5 * dt;
        if (rejectedSteps == kMostRejectedSteps || state_.memory.longest < scene_.settings.time.dtMin) throw failure(*fault, rejectedSteps, dt);
        lost += seconds(Clock::now() - kept);
    }
}

}  // namespace sim
