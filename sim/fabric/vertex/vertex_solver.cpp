#include "sim/fabric/vertex/vertex_solver.h"

#include "sim/core/parallel.h"
#include "sim/fabric/contact/spring_step.h"
#include "sim/fabric/held.h"
#include "sim/fabric/owed_energy.h"
#include "sim/fabric/pins.h"
#include "sim/fabric/reference_acceleration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace sim {

namespace {

constexpr double kExpectedMove = 0.3;    ///< farthest that forces are expected to move a vertex against its free flight [radii]
constexpr double kExpectedTurn = 0.1;    ///< farthest that twist angles are expected to go on as they did [rad]
constexpr double kFractionTwice = 0.95;  ///< accepted part of the moves below which, twice running, a step is halved [-]
constexpr double kFractionOnce = 0.7;    ///< accepted part of the moves below which a step is halved at once [-]
constexpr int kDrivenHalvings = 2;       ///< halvings of a step in which something drives the fabric, that may be made at least
constexpr int kMaxListBuilds = 25;       ///< builds of the candidate list in an attempt at most; more ask for halves
constexpr double kOwedInSecondOrder =
    1.0e-3;  ///< debt with which fabric goes on by the scheme of second order, relative to the largest kinetic energy: more is of what drives it [-]
constexpr double kMuchGain = 0.1;  ///< energy from nothing, relative to that of the motion: more, after all iterations, asks for halves [-]

}  // namespace

VertexSolver::VertexSolver(const Fabric& fabric, const FabricSettings& settings, std::span<const ObstacleSettings> obstacles,
                           std::optional<Cohesion> cohesion)
    : fabric_(fabric),
      settings_(settings),
      system_(fabric, settings),
      cohesion_(std::move(cohesion)),
      groups_(fabric),
      attemptGroups_(fabric),
      restReference_(restState(fabric).reference),
      nearestPin_(nearestPins(fabric))
{
    if (settings.contact) {
        contact_.emplace(fabric, cohesion_ ? &*cohesion_ : nullptr);
        obstacles_ = FabricObstacles(fabric, obstacles, cohesion_ ? &*cohesion_ : nullptr);
        solidLimiter_ = SolidLimiter(fabric, obstacles);
    }
    totalMass_ = std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
    meanRadius_ = std::inner_product(fabric.mass.begin(), fabric.mass.end(), fabric.radius.begin(), 0.0) / totalMass_;
    mass_.resize(fabric.vertexCount());
    inertia_.resize(fabric.vertexCount());
    free_.resize(fabric.vertexCount());
    move_.resize(fabric.vertexCount());
    expected_.resize(fabric.vertexCount());
    freeAngle_.resize(fabric.edges.size());
}

FabricReport VertexSolver::advance(double t, double h, const Vec3& gravity, FabricState& state, StageClock& clock, const FabricLoads& loads)
{
    FabricReport report;
    if (booksEnergy_) report.energyChanges.emplace();
    loads_ = loads.onVertices;
    wholeStep_ = h;
    parallelFor(fabric_.vertexCount(), 4096, [&](std::size_t v) { mass_[v] = fabric_.mass[v] + state.absorbed[v]; });
    gravity_ = gravity;
    referenceAcceleration_ = referenceAcceleration(
        gravity, mass_, state.v, fabric_.radius, [&] { return energies(state, gravity).elastic(); }, h);
    const double farthest = parallelMax(state.x.size(), [&](std::size_t v) { return state.x[v].cwiseAbs().maxCoeff(); });
    placeRounding_ = std::numeric_limits<double>::epsilon() * farthest;
    if (cohesion_) cohesion_->setAbsorbed(state.absorbed);
    groups_.begin();
    findMomenta(state);
    advanceInParts({t, h, 0, state, report, clock});
    const double kinetic = booksEnergy_ ? energies(state, gravity).kinetic : 0.0;
    conserveMomentum(h, state);
    if (booksEnergy_) (*report.energyChanges)[EnergyChange::Implicit] += energies(state, gravity).kinetic - kinetic;
    if (forces_ && loads_) reportLiquid(state);
    report.candidates = contact_ ? contact_->candidates() : 0;
    return report;
}

void VertexSolver::advanceInParts(const Part& part)
{
    if (trySubstep(part)) return;
    ++part.report.substepSplits;
    start_.vertexSolver.lastFraction = part.state.vertexSolver.lastFraction;
    part.state = start_;
    advanceInParts(part.half(part.t));
    advanceInParts(part.half(part.t + 0.5 * part.h));
}

/// Where vertices and angles go without forces of the fabric's own, and in move_ where forces like those of the last step take the
/// vertices, where there is contact by no more than it is sure to notice; pins go where their motion has them. Newton begins there: quiet
/// fabric finds its forces in balance and its friction at the speed that it has, instead of after a fall for one step.
void VertexSolver::predict(const Part& step)
{
    const FabricState& state = step.state;
    const double h = step.h;
    const Vec3 fall = h * h * gravity_;
    const double part = h / wholeStep_;
    const double expectedMove = contact_ ? kExpectedMove : std::numeric_limits<double>::infinity();  // radii
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) {
        const double mass = mass_[v];
        inertia_[v] = Vec3::Constant(mass);
        move_[v] = h * state.v[v] + fall;
        if (isSecondOrder_) {
            const bossak::Vertex at = bossakOf(v, h);
            inertia_[v] = at.inertia();
            move_[v] = at.freeMove();
        } else if (loads_) {
            inertia_[v] += part * loads_->drag[v];
            move_[v] = (mass * move_[v] + (h * part) * loads_->impulse[v]).cwiseQuotient(inertia_[v]);
        }
        Vec3 byForces = h * h * state.acceleration[v];
        if (loads_ || isSecondOrder_) byForces = (mass * byForces).cwiseQuotient(inertia_[v]);
        const double most = expectedMove * fabric_.radius[v], size = byForces.norm();
        free_[v] = state.x[v] + move_[v];
        expected_[v] = move_[v] + byForces;
        const bool stays = expected_[v].squaredNorm() <= most * most;  // and so feels what it feels where it is
        move_[v] += (size > most && !stays ? most / size : 1.0) * byForces;
    });
    const std::vector<Vec3> targets = pinTargets(fabric_, step.t + h);
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        free_[v] = targets[i];
        expected_[v] = move_[v] = free_[v] - state.x[v];
    }
    parallelFor(freeAngle_.size(), 4096, [&](std::size_t e) { freeAngle_[e] = state.theta[e] + h * state.omega[e]; });
}

/// Material frames of held edges follow their pins' rotation.
void VertexSolver::turnHeldEdges(double t, FabricState& state) const
{
    for (std::size_t e = 0; e < fabric_.edges.size(); ++e)
        if (fabric_.edges.twistHeld[e]) state.theta[e] = heldAngle(fabric_, restReference_, t, state, static_cast<int>(e));
}

/// Newton's first point: where nothing but the limiter and the pins hold the fabric. Angles begin next to where they are:
/// twist is so stiff and light that its rate tells little of where it will be, that of a halved step nothing; from there Newton wound up
/// the free ends of yarns, a little in every step. False if the attempt should be redone in halves.
bool VertexSolver::beginAttempt(const Part& part, bool isLast)
{
    const double t = part.t, h = part.h;
    FabricState& state = part.state;
    start_ = state;
    startTime_ = t;
    startEnergies_ = energies(start_, gravity_);
    start_.mostKinetic = state.mostKinetic = std::max(start_.mostKinetic, startEnergies_.kinetic);
    isSecondOrder_ = settings_.integrator == FabricTimeIntegrator::SecondOrder &&
                     state.vertexSolver.owed <= std::max(referenceEnergy(0.0, h), kOwedInSecondOrder * state.mostKinetic);
    startIsChecked_ = false;
    pinForce_.clear();
    undetectedAtStart_ = 0.0;
    part.clock.start(Stage::FabricElastic);
    elasticStep_ = system_.startStep(state);
    predict(part);
    obstacles_.moveTo(t, t + h);
    solidLimiter_.moveTo(t, t + h);
    solidsMove_ = solidLimiter_.movesNear(state.x, move_);
    isDriven_ = solidsMove_ || std::ranges::any_of(fabric_.pins.motions, [&](const Motion& motion) { return motion.moves(t, t + h); });
    // Where something drives the fabric, a step is halved for the sake of stiffer springs, which all of the motion may pay for (dissipateGain).
    const double bearable = isDriven_ && h < wholeStep_ ? 1.0 : kStiffeningGain;
    const double kinetic = start_.springStep > h ? ownKinetic(fabric_, groups_, mass_, start_) : 0.0;
    springStep_ = springStepFor(start_.springStep, h, start_.stored.springs(), bearable * referenceEnergy(kinetic, h));
    state.springStep = springStep_;
    limits_ = {};
    solidLimits_.clear();
    if (contact_) contact_->beginStep(state.x, mass_, stepOfInertia(h), springStep_, start_.vertexSolver.onFabric);

    if (!followSolids(part, isLast)) return false;
    parallelFor(freeAngle_.size(), 4096,
                [&](std::size_t e) { state.theta[e] += std::clamp(freeAngle_[e] - state.theta[e], -kExpectedTurn, kExpectedTurn); });
    turnHeldEdges(t + h, state);
    return true;
}

/// What a step leaves behind when the fabric is where it ends, besides rates: what friction holds, and the energy of contact.
void VertexSolver::storeContacts(double h, FabricState& state)
{
    if (contacts_) contacts_->storeFriction(state.x, state.vertexSolver.onFabric);
    else state.vertexSolver.onFabric.clear();
    if (solids_) solids_->storeFriction(state.x, obstacleStart(h), state.onObstacles);
    else state.onObstacles.clear();
    state.stored = contactEnergy(h, state.x, state);
}

bool VertexSolver::trySubstep(const Part& part)
{
    const double h = part.h;
    FabricState& state = part.state;
    FabricReport& report = part.report;
    bool isLast = part.level >= settings_.maxHalvings;
    if (!beginAttempt(part, isLast)) return false;
    Newton newton;
    iterate(part, newton);

    const double fraction = newton.wanted > 0.0 ? newton.taken / newton.wanted : 1.0;
    const bool isShort = fraction < kFractionOnce || (fraction < kFractionTwice && start_.vertexSolver.lastFraction < kFractionTwice) ||
                         limits_.candidateListBuilds > kMaxListBuilds || solidLimits_.left > 0 || !newton.hasConverged ||
                         (newton.gain > kMuchGain && (isDriven_ || !newton.hasNegligibleChange));
    state.vertexSolver.lastFraction = fraction;
    // What drives the fabric gives it energy however little it may follow: that it cannot must be known.
    if (isDriven_) isLast = isLast && part.level >= kDrivenHalvings;
    if (isShort && !isLast) return false;
    report.acceptedFraction = std::min(report.acceptedFraction, fraction);

    if (isShort) ++report.truncatedSubsteps;
    findGroups(groups_);
    const bool mayHaveGained = startIsChecked_ || isShort;
    if (mayHaveGained && !isDriven_) removeSpuriousGain(part);
    else if (isSecondOrder_ && !isDriven_) state.vertexSolver.owed = std::max(0.0, gainSoFar(state, groups_));
    std::optional<EnergyChanges> changes;
    if ((mayHaveGained && isDriven_) || (start_.vertexSolver.owed > 0.0 && (isDriven_ || !isSecondOrder_))) changes = dissipateGain(h, state);
    if (isSecondOrder_) keepRecoverable(state);
    if (state.vertexSolver.owed > 0.0) throwJammed(fabric_, state, referenceEnergy(energies(state, gravity_).kinetic, h));
    if (booksEnergy_ && !changes) changes = energyChanges(h, state);
    for (std::size_t i = 0; i < pinForce_.size(); ++i) state.vertexSolver.force[fabric_.pins.vertex[i]] = pinForce_[i];
    if (booksEnergy_) *report.energyChanges += *changes;
    if (forces_) reportForces(h, state);
    return true;
}

FabricEnergies VertexSolver::energies(const FabricState& state, const Vec3& gravity) const
{
    return fabricEnergies(fabric_, state, elastic_.at(state, system_.rods(), system_.shells()), gravity);
}

double VertexSolver::leastDistance() const { return contact_ ? contact_->leastDistance() : std::numeric_limits<double>::infinity(); }

}  // namespace sim
