#include "sim/fabric/grid/grid_solver.h"

#include "sim/core/parallel.h"
#include "sim/fabric/contact/spring_step.h"
#include "sim/fabric/reference_acceleration.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace sim {

namespace {

/// Rms error of accelerations at which the linear solve is good enough, relative to referenceAcceleration. In steps of 2e-4 s under the earth's
/// gravity that is 1e-3 cm/s (fabric/grid/README.md, Linear system); errors of all steps of a second add up to the same at any length.
constexpr double kAccelerationTolerance = 0.005;
/// Beyond so many iterations errors are borne up to another share of it; larger ones would push liquid with forces that no fabric has, and make
/// energy, so that the solve goes on however long it takes.
constexpr int kMaxIterations = 200, kMostIterations = 20000;
constexpr double kAcceptable = 0.1;  ///< error of a solve that is acceptable, relative to referenceAcceleration [-]
/// Share of the acceleration tolerance below which accelerations are not felt, and their contact is left out [-].
constexpr double kNegligible = 0.01;

}  // namespace

GridFabricSolver::GridFabricSolver(const Fabric& fabric, const Settings& settings, std::span<const ObstacleSettings> obstacles, bool meetsLiquid)
    : fabric_(fabric),
      settings_(settings.fabric),
      stiffness_(fabric, settings.fabric),
      contact_(fabric),
      particles_(fabric, settings),
      system_(fabric, stiffness_, contact_),
      groups_(fabric),
      meetsLiquid_(meetsLiquid),
      mass_(fabric.mass)
{
    if (settings_.contact) {
        obstacles_ = FabricObstacles(fabric, obstacles);
        solidLimiter_ = SolidLimiter(fabric, obstacles);
    }
    move_.resize(fabric.vertexCount());
    wanted_.resize(fabric.vertexCount());
    points_.resize(contact_.size());
    predicted_.resize(fabric.vertexCount());
    reached_.resize(fabric.vertexCount());
    expectedMove_.resize(fabric.vertexCount());
}

/// Gives a state that comes from elsewhere what this solver keeps in it.
void GridFabricSolver::begin(FabricState& state)
{
    if (!state.gridSolver.across.empty()) return;
    state.gridSolver.across = contact_.unstrained(state);
    std::ranges::fill(state.held, Vec3::Zero());  // a face may give way where others keep the vertex in its place
}

/// v0: what P2G gave, fallen for h and moved by the liquid; the twist goes on as it did.
void GridFabricSolver::startVelocities(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads)
{
    velocity_.resize(system_.blocks(), system_.edges());
    const BlockArray<double, 3>&mass = system_.mass(), &velocity = particles_.velocity();
    parallelFor(system_.blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b), loaded = loads ? loads->grid.find(particles_.grid().coords(block)) : BlockGrid::kNone;
        for (int a = 0; a < kAxes; ++a) {
            const double *m = mass.block(block, a), *from = velocity.block(block, a);
            double* to = velocity_.faces.block(block, a);
            for (int c = 0; c < kBlockCells; ++c) to[c] = m[c] > 0.0 ? from[c] + h * gravity[a] : 0.0;
            if (loaded == BlockGrid::kNone) continue;
            // The system's mass holds the drag D': (M + D') v0 = M (v + h g) + J.
            const double *drag = loads->drag.block(loaded, a), *impulse = loads->impulse.block(loaded, a);
            for (int c = 0; c < kBlockCells; ++c)
                if (m[c] > 0.0) to[c] += (impulse[c] - drag[c] * to[c]) / m[c];
        }
    });
    velocity_.twist.fill(0.0);
    std::ranges::copy(state.omega, velocity_.twist.begin());
}

/// Energy of the fabric when it has made a part of move_ in h, with the angles that it already has: kinetic, by weight, elastic [erg].
GridFabricSolver::Mechanical GridFabricSolver::energyAfter(double part, double h, const Vec3& gravity, const FabricState& state)
{
    FabricState& at = trial_;
    at.x.resize(state.x.size());
    parallelFor(at.x.size(), 1024, [&](std::size_t v) { at.x[v] = state.x[v] + part * move_[v]; });
    at.theta = state.theta, at.tangent = state.tangent, at.reference = state.reference, at.referenceTwist = state.referenceTwist;
    stiffness_.rods().transportFrames(at);
    const double free = parallelSum(move_.size(), [&](std::size_t v) {
        const Vec3 move = part * move_[v];
        return mass_[v] * (0.5 * move.squaredNorm() / (h * h) - gravity.dot(move));
    });
    return {free, elasticEnergies(at, stiffness_.rods(), stiffness_.shells()).elastic()};
}

/// Part of move_, which solids at rest have changed, with which they give the fabric no energy, or the least of it [0..1]. Where some
/// vertices are stopped and those beside them go on, threads stretch, which is paid for by what all of them lose of their motion.
double GridFabricSolver::partWithoutGain(double limit, double h, const Vec3& gravity, const FabricState& state)
{
    double best = 1.0, least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0, 0.5, 0.25, 0.125, 0.0}) {
        const double energy = energyAfter(part, h, gravity, state).sum();
        if (energy < least) best = part, least = energy;
        if (energy <= limit) break;
    }
    return best;
}

/// Along their velocities, but not through solids: what is stopped or carried by one has the velocity of where it got.
void GridFabricSolver::moveVertices(double t, double h, const Vec3& gravity, FabricState& state, FabricReport& report)
{
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) { wanted_[v] = move_[v] = h * state.v[v]; });
    SolidLimitReport guarded;
    const SolidLimiter::Limited limited = solidLimiter_.limitBisected(t, h, state.x, mass_, move_, guarded);
    if (limited.moves == SolidLimiter::Limited::Moves::Changed) {
        move_.swap(wanted_);
        const Mechanical wanted = energyAfter(1.0, h, gravity, state);
        move_.swap(wanted_);
        // Solids and pins that move may give energy; and pins must get to where they are led.
        const bool isDriven = limited.isDriven || std::ranges::any_of(fabric_.pins.motions, [](const Motion& motion) { return !motion.isStatic(); });
        const double part = isDriven ? 1.0 : partWithoutGain(wanted.sum(), h, gravity, state);
        parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) {
            move_[v] *= part;
            state.v[v] = move_[v] / h;
        });
        if (booksEnergy_) {
            const Mechanical got = energyAfter(1.0, h, gravity, state);
            (*report.energyChanges)[EnergyChange::Obstacles] += got.sum() - wanted.sum();
            (*report.energyChanges)[EnergyChange::FabricToVertices] -= got.free - wanted.free;
            (*report.energyChanges)[EnergyChange::Implicit] -= got.elastic - wanted.elastic;
        }
    }
    if (forces_ && !solidLimiter_.empty()) reportSolidLimiter(h, state);
    if (guarded.left > 0) ++report.truncatedSubsteps;
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) { state.x[v] += move_[v]; });
}

/// What forces did in the last step, on the faces of this one; null in the first.
const BlockArray<double, 3>* GridFabricSolver::expectedChange(const FabricState& state)
{
    if (state.gridSolver.faceBlocks.count() == 0) return nullptr;
    expected_.resize(system_.blocks());
    parallelFor(system_.blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b), before = state.gridSolver.faceBlocks.find(particles_.grid().coords(block));
        double* to = expected_.block(block);
        if (before == BlockGrid::kNone) std::fill_n(to, kAxes * kBlockCells, 0.0);
        else std::copy_n(state.gridSolver.faceChange.block(before), kAxes * kBlockCells, to);
    });
    return &expected_;
}

/// How the solve changed velocities, for that of the next step.
void GridFabricSolver::storeChange(FabricState& state) const
{
    state.gridSolver.faceBlocks = particles_.grid();
    state.gridSolver.faceChange.resize(system_.blocks());
    parallelFor(system_.blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        const double *start = start_.block(block), *v = velocity_.faces.block(block);
        double* change = state.gridSolver.faceChange.block(block);
        for (int c = 0; c < kAxes * kBlockCells; ++c) change[c] = v[c] - start[c];
    });
}

/// Accelerations by the fabric's own forces, for liquid (coupling/README.md, Mixture) and friction to expect in the next step.
void GridFabricSolver::storeAccelerations(double h, FabricState& state)
{
    const BlockArray<double, 3>& inertia = system_.mass();
    const auto& mass = particles_.faces().sums;
    acceleration_.resize(system_.blocks());
    parallelFor(system_.blocks(), 8, [&](std::size_t b) {
        const int block = static_cast<int>(b);
        for (int a = 0; a < kAxes; ++a) {
            const double *m = inertia.block(block, a), *own = mass.block(block, FaceFields::kMass + a),
                         *change = state.gridSolver.faceChange.block(block, a);
            double* to = acceleration_.block(block, a);
            for (int c = 0; c < kBlockCells; ++c) to[c] = m[c] > 0.0 ? m[c] * change[c] / (h * own[c]) : 0.0;
        }
    });
    system_.gatherVertices(acceleration_, state.acceleration);
}

/// Contacts with obstacles where the vertices would be at the end of the step, which is in front of them. motion_ must hold how they would go
/// without the fabric's own forces; friction expects these to act on as they did.
FabricObstacles::Found GridFabricSolver::touchObstacles(double t, double h, const Vec3& gravity, const FabricState& state)
{
    obstacles_.moveTo(t, t + h);
    solidLimiter_.moveTo(t, t + h);
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) { move_[v] = h * (state.v[v] + h * gravity); });
    SolidLimitReport ahead;
    solidLimiter_.limit(state.x, mass_, move_, ahead);
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) {
        predicted_[v] = move_[v] / h;
        reached_[v] = state.x[v] + move_[v];
        expectedMove_[v] = h * (motion_.velocity[v] + h * state.acceleration[v]);
    });
    const std::span<const NearestPoint> nearest = solidLimiter_.nearestPoints(reached_);
    from_ = state.x;
    FabricObstacles::Start start = obstacleStart(h, state);
    start.moves = expectedMove_;
    return obstacles_.findContacts(fabric_, reached_, start, nearest);
}

void GridFabricSolver::prepare(FabricState& state, StageClock& clock)
{
    begin(state);
    clock.start(Stage::FabricToGrid);
    if (meetsLiquid_) {
        parallelFor(mass_.size(), 4096, [&](std::size_t v) { mass_[v] = fabric_.mass[v] + state.absorbed[v]; });
        system_.setAbsorbed(state.absorbed);
    }
    parallelFor(contact_.size(), 1024, [&](std::size_t e) { points_[e] = contact_.position(e, state.x); });
    particles_.toFaces(mass_, points_, state);
}

/// How the fabric will move by motion_, where contact matters that makes more than a share of the solve's tolerance.
PredictedMotion GridFabricSolver::predictionOn(double h, const FaceTolerance& tolerance) const
{
    return {motion_, h, particles_.grid().dx, kNegligible * tolerance.target / h};
}

FabricReport GridFabricSolver::advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& of)
{
    FabricReport report;
    const FaceLoads* loads = of.onFaces;
    const double felt = referenceAcceleration(
        gravity, mass_, state.v, fabric_.radius, [&] { return energies(state, gravity).elastic(); }, h);
    const double tolerance = settings_.tolerance > 0.0 ? settings_.tolerance : kAccelerationTolerance * felt * h;
    const FaceTolerance until{tolerance, kMaxIterations, kAcceptable * felt * h, kMostIterations};
    clock.start(Stage::FabricContact);
    const FaceSystem::Begun begun = system_.begin(particles_, h, loads);
    startVelocities(h, gravity, state, loads);
    const double kinetic =
        parallelSum(mass_.size(), [&](std::size_t v) { return 0.5 * mass_[v] * (state.v[v].squaredNorm() + felt * felt * h * h); });
    state.springStep = springStepFor(state.springStep, h, state.stored.solids, kStiffeningGain * kinetic);
    std::optional<FabricObstacles::Found> onSolids;
    ElementContact::Assembled contact = contact_.assembleNone();
    if (settings_.contact) {
        system_.findMotion(begun, velocity_.faces, motion_);
        if (!obstacles_.empty()) onSolids = touchObstacles(t, h, gravity, state);
        const PredictedMotion prediction = predictionOn(h, until);
        contact = contact_.assemble(state, &prediction);
    }
    const std::span<const ObstacleContact> touching = onSolids ? std::span(onSolids->contacts()) : std::span<const ObstacleContact>();

    clock.start(Stage::FabricElastic);
    const VertexStiffness::Assembled stiffness = stiffness_.assemble(state, t, h, touching, predicted_);
    system_.assemble(begun, stiffness, contact);

    clock.start(Stage::FabricSolve);
    solve({h, gravity, state, loads, until, begun, stiffness, contact, kinetic}, report);
    conserveMomentum(touching);
    report.contacts = contact_.active().size();
    report.obstacleContacts = touching.size();
    if (booksEnergy_) bookSolve(h, gravity, state, loads, report.energyChanges.emplace());
    if (forces_) reportSprings(h, state, touching);
    if (forces_ && loads) reportLiquid(state, *loads);

    clock.start(Stage::GridToFabric);
    storeChange(state);
    if (meetsLiquid_ || !obstacles_.empty()) storeAccelerations(h, state);
    particles_.velocity().swap(velocity_.faces);
    particles_.toVertices(h, state);
    const double kept = particles_.retainedVelocity(h);
    for (std::size_t e = 0; e < fabric_.edges.size(); ++e) {
        state.omega[e] = kept * velocity_.twist[e];
        state.theta[e] += h * state.omega[e];
    }
    moveVertices(t, h, gravity, state, report);
    state.vertexSolver.onFabric.clear();
    if (!onSolids) state.onObstacles.clear();
    else onSolids->storeFriction(state.x, obstacleStart(h, state), state.onObstacles, state.acceleration);
    state.gridSolver.sinceGather = h;
    stiffness_.rods().transportFrames(state);

    clock.start(Stage::FabricStrain);
    const ContactEnergy before = state.stored;
    state.stored.solids = onSolids ? onSolids->storedEnergy(state.x, obstacleStart(h, state), state.onObstacles) : 0.0;
    if (settings_.contact) state.stored.pressed = contact_.advectDirections(predictionOn(h, until), kOmittedEnergy * kinetic, state);
    if (booksEnergy_) bookVertices(gravity, before, state, *report.energyChanges);
    return report;
}

FabricEnergies GridFabricSolver::energies(const FabricState& state, const Vec3& gravity) const
{
    return fabricEnergies(fabric_, state, elastic_.at(state, stiffness_.rods(), stiffness_.shells()), gravity);
}

}  // namespace sim
