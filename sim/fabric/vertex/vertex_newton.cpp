#include "sim/core/parallel.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <algorithm>
#include <cmath>
#include <optional>

// Newton's iterations of one attempt: what touches, where the linear solve leads, how far the limiter lets it, and when it is enough.

namespace sim {

namespace {

constexpr double kTolerance = 1.0e-2;    ///< error left by linear solves: looser ones act as damping (fabric/vertex/README.md, Linear solve) [-]
constexpr double kMoveTolerance = 0.05;  ///< rms error of moves at which iterations end [radii]
/// rms error of accelerations at which iterations end: more makes energy from step to step [referenceAcceleration]
constexpr double kAcceptable = 0.05;
constexpr double kRoundings = 4.0;           ///< motion that counts as none, in roundings of places in a step [-]
constexpr double kLeftAtContact = 0.3;       ///< share left of errors too small to be felt: they would shake loose what friction holds just so [-]
constexpr double kQuietAcceleration = 0.25;  ///< largest change by a Newton iteration after whose small move no other is made [referenceAcceleration]
constexpr double kLastMove = 0.1;            ///< rms move of a Newton iteration that may be the last [radii]
constexpr double kSettledMove = 0.25;        ///< rms move of an iteration after which a step needs no halves [radii]
constexpr double kSmallMove = 0.03;          ///< rms move after which a step needs no halves though moves do not become smaller [radii]
constexpr double kContraction = 0.5;         ///< ratio of an iteration's move to the one before that counts as smaller [-]
constexpr int kMostNewton = 6;               ///< Newton iterations towards a small move at most; more ask for halves
constexpr double kFrictionError = 0.05;      ///< error of friction with which a step may end: more sticks where it should slide [-]
constexpr int kMostForFriction = 12;         ///< iterations where friction errs: each takes half of the error or more, so that halves would cost more
constexpr double kSignificantFriction = 0.2;  ///< friction below which its error does not matter [referenceAcceleration]
constexpr int kMaxLinearIterations = 1000;

}  // namespace

/// What touches at x.
/// @param expected  ActiveContacts, FabricObstacles::Start
void VertexSolver::findContacts(double h, std::span<const Vec3> x, std::span<const Vec3> expected, StageClock& clock)
{
    contacts_.reset();
    if (contact_ && contact_->candidates() > 0) contacts_ = contact_->activeAt(x, clock, expected);
    solids_.reset();
    if (obstacles_.empty()) return;
    clock.start(Stage::FabricContact);
    FabricObstacles::Start start = obstacleStart(h);
    start.moves = expected;
    solids_ = obstacles_.findContacts(fabric_, x, start, solidLimiter_.nearestPoints(x));
}

/// Newton's move from where the state is, into move_.
void VertexSolver::solve(const Part& part, Newton& newton)
{
    const double h = part.h;
    const FabricState& state = part.state;
    FabricReport& report = part.report;
    findContacts(h, state.x, newton.count == 0 ? std::span<const Vec3>(expected_) : std::span<const Vec3>(), part.clock);
    hasMovedSinceDetection_ = true;
    part.clock.start(Stage::FabricElastic);
    const NewtonPoint point{*elasticStep_, state, free_, freeAngle_, inertia_, h, isSecondOrder_ ? 2.0 : 1.0};
    system_.assemble(point, touching(), contacts());
    part.clock.start(Stage::FabricSolve);
    const double share = settings_.tolerance > 0.0 ? settings_.tolerance : kTolerance;
    const double fall = referenceAcceleration_ * h;
    const bool isTouching = !touching().empty() || (contacts_ && contacts_->pairs().size() > 0);
    const LinearTolerance tolerance = {share, kAccelerationTolerance * fall * share / kTolerance,
                                       std::min(kMoveTolerance * meanRadius_ / h, kAcceptable * fall), isTouching ? kLeftAtContact : 1.0,
                                       kRoundings * placeRounding_ / h};
    LinearReport linear = system_.solve(tolerance, newton.count == 0, kMaxLinearIterations);
    if (linear.isIndefinite) {
        report.iterations += linear.iterations;
        system_.assembleDefinite(point, touching(), contacts());
        linear = system_.solve(tolerance, newton.count == 0, kMaxLinearIterations);
    }
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) { move_[v] = system_.move(static_cast<int>(v)); });
    ++report.newton;
    report.iterations += linear.iterations;
    report.speedError = std::max(report.speedError, linear.speedError);
    report.contacts = contacts_ ? contacts_->pairs().size() : 0;
    report.obstacleContacts = touching().size();
}

/// Has the last move left nothing worth another? One by which nothing moved far, or much less far than before.
void VertexSolver::checkConvergence(double h, Newton& newton) const
{
    const double largest = parallelMax(fabric_.vertexCount(), [&](std::size_t v) { return move_[v].norm(); });
    const double move = rmsInRadii(move_);
    newton.hasNegligibleChange = largest < kQuietAcceleration * referenceAcceleration_ * h * h && move < kSmallMove;
    newton.hasConverged = move < kSmallMove || (move < kSettledMove && (newton.count == 0 || move < kContraction * newton.lastMove));
    newton.isNearSolution = newton.hasConverged && move < kLastMove;
    newton.lastMove = move;
    ++newton.count;
}

/// Makes the move as far as the limiter lets it.
void VertexSolver::applyStep(const Part& part, Newton& newton)
{
    FabricState& state = part.state;
    const LimitedMove limited = limit(state, part.report, part.clock);
    const auto sumOver = [&](auto&& of) { return parallelSum(fabric_.vertexCount(), [&](std::size_t v) { return mass_[v] * of(v); }); };
    newton.wanted += sumOver([&](std::size_t v) { return system_.move(static_cast<int>(v)).squaredNorm(); });
    newton.taken += sumOver([&](std::size_t v) { return system_.move(static_cast<int>(v)).dot(move_[v]); });
    commit(limited, state, part.clock);
    parallelFor(freeAngle_.size(), 4096, [&](std::size_t e) { state.theta[e] += system_.turn(static_cast<int>(e)); });
    turnHeldEdges(part.t + part.h, state);
}

/// Weighted by mass.
double VertexSolver::rmsInRadii(std::span<const Vec3> move) const
{
    const double sum =
        parallelSum(move.size(), [&](std::size_t v) { return fabric_.mass[v] * move[v].squaredNorm() / (fabric_.radius[v] * fabric_.radius[v]); });
    return std::sqrt(sum / totalMass_);
}

/// Moves the fabric by move_.
void VertexSolver::commit(const LimitedMove& move, FabricState& state, StageClock& clock)
{
    clock.start(Stage::FabricElastic);
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) { state.x[v] += move_[v]; });
    if (move.betweenFabric) contact_->moved(*move.betweenFabric);
    system_.rods().transportFrames(state);
}

/// Newton's iterations until nothing moves that matters, and no energy comes from what is left.
void VertexSolver::iterate(const Part& part, Newton& newton)
{
    const double h = part.h;
    FabricState& state = part.state;
    const int most = std::max(settings_.newton, kMostNewton);
    std::optional<Newton> settled;  // before iterations for the energy's sake, which tell nothing of how far a step could be taken
    for (;;) {
        solve(part, newton);
        checkConvergence(h, newton);
        applyStep(part, newton);
        const bool isLastMove = newton.hasNegligibleChange || newton.count >= (newton.isNearSolution ? settings_.newton : most);
        if (!isLastMove) continue;
        const double frictionError = contacts_ ? contacts_->frictionError(state.x, kSignificantFriction * referenceAcceleration_) : 0.0;
        // Steps that something drives are halved instead: shorter ones take less energy from it that fabric cannot follow.
        if (frictionError > kFrictionError && newton.count < (isDriven_ ? most : std::max(most, kMostForFriction))) continue;
        newton.hasConverged = newton.hasConverged && frictionError <= kFrictionError;
        findRates(h, state);
        storeContacts(h, state);
        if (!settled) settled = newton;
        newton.hasConverged = settled->hasConverged, newton.wanted = settled->wanted, newton.taken = settled->taken;
        if (gain(h, state) <= kNegligibleGain) return;
        updateContacts(h, state, part.clock);
        newton.gain = gain(h, state);
        if (newton.gain <= kNegligibleGain || newton.count >= most) return;
    }
}

}  // namespace sim
