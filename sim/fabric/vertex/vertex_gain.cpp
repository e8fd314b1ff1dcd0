#include "sim/core/parallel.h"
#include "sim/fabric/owed_energy.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <algorithm>
#include <cmath>

// Implicit steps take energy. What a step gains where nothing drives the fabric it has from a Newton iteration that has not come to a
// solution, or from contact that the step before did not see.

namespace sim {

namespace {

/// Most that the scheme of second order gives back in a step, of the energy of the motion: 2.6 % where a step is a third of a period [-]
constexpr double kMostRecovered = 0.03;
constexpr double kRemembered =
    0.9;  ///< share of what it took before that the scheme may still give back, per step: in a swing of 20 it takes for five [-]

}  // namespace

/// Energy of contact at x, of what touched at the last look, with the friction that is held.
ContactEnergy VertexSolver::contactEnergy(double h, std::span<const Vec3> x, const FabricState& held) const
{
    ContactEnergy stored;
    if (contacts_) stored = contacts_->storedEnergy(x, held.vertexSolver.onFabric);
    if (!solids_) return stored;
    stored.solids = solids_->storedEnergy(x, obstacleStart(h), held.onObstacles);
    stored.bridges += solids_->bridgeEnergy(x);
    return stored;
}

/// Energy that the fabric may have at the end of a step [erg]: that of the start, and what was given. Where nothing moves this is the
/// liquid's work alone, and the rest need not be known.
double VertexSolver::allowedEnergy(double h, const FabricState& state)
{
    if (isDriven_) return startEnergies_.total() + workOutside(h, state);
    if (!loads_) return startEnergies_.total();
    return startEnergies_.total() + h / wholeStep_ * parallelSum(state.x.size(), [&](std::size_t v) {
                                        return (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v])).dot(workingVelocity(v, state));
                                    });
}

/// Work of gravity that groups which nothing holds have in their speed and not in their way, by the scheme of second order [erg]: their momentum is
/// exact, and their way is h² (A − a)/8 longer than its mean speeds. This is to and fro, and not energy from nothing. Only liquid changes A.
double VertexSolver::aheadOfWay(double h, const FabricState& state, const FabricGroups& groups) const
{
    if (!isSecondOrder_ || !loads_ || !touching().empty() || !groups.anyFree()) return 0.0;
    return parallelSum(state.x.size(), [&](std::size_t v) {
        if (groups.freeGroupOf(groups.pieceOf(static_cast<int>(v))) < 0) return 0.0;
        return mass_[v] * gravity_.dot(0.5 * h * (start_.v[v] + state.v[v]) - (state.x[v] - start_.x[v]));
    });
}

/// Kinetic energy of a motion, or of one that is not felt [erg].
double VertexSolver::referenceEnergy(double kinetic, double h) const
{
    const double unfelt = kAccelerationTolerance * referenceAcceleration_ * h;
    return kinetic + 0.5 * totalMass_ * unfelt * unfelt;
}

/// Energy that a step gained from nothing, relative to that of its motion but for the drift of what nothing holds, beyond that of contact which
/// was not seen at its start; less than what is not felt counts as none. The scheme of second order is not held to take energy in every step: with
/// what its steps gained and have not lost again (owed) it may have as much as is not felt.
double VertexSolver::gain(double h, const FabricState& state)
{
    made_ = energies(state, gravity_).total() - allowedEnergy(h, state) - undetectedAtStart_;
    if (made_ <= 0.0 && !isSecondOrder_) return 0.0;
    attemptGroups_.begin();
    findGroups(attemptGroups_);
    made_ -= aheadOfWay(h, state, attemptGroups_);
    if (made_ <= 0.0) return 0.0;
    const double scale = referenceEnergy(ownKinetic(fabric_, attemptGroups_, mass_, state), h);
    const double spurious = gainSoFar(state, attemptGroups_);
    return spurious <= std::max(kNegligibleGain * scale, bearableGain(h)) ? 0.0 : spurious / scale;
}

/// Energy that may come and go with steps of the scheme of second order [erg]: as much as is not felt.
double VertexSolver::bearableGain(double h) const { return isSecondOrder_ ? referenceEnergy(0.0, h) : 0.0; }

/// What the attempt made, and by the scheme of second order what steps before it made and none has lost since [erg].
double VertexSolver::gainSoFar(const FabricState& state, const FabricGroups& groups) const
{
    return made_ - recovered(state, groups) + (isSecondOrder_ ? start_.vertexSolver.owed : 0.0);
}

/// What was lost where things met is lost for good.
void VertexSolver::keepRecoverable(FabricState& state) const
{
    const bool isFree = acting_.empty() && !isDriven_;
    const double change = isFree ? made_ : std::max(made_, 0.0);
    state.vertexSolver.recoverable = kRemembered * std::max(0.0, start_.vertexSolver.recoverable - change);
}

/// What the scheme of second order may give back of what it took in the steps before [erg].
double VertexSolver::recovered(const FabricState& state, const FabricGroups& groups) const
{
    if (!(start_.vertexSolver.recoverable > 0.0)) return 0.0;
    const double own = ownKinetic(fabric_, groups, mass_, state) + energies(state, gravity_).elastic();
    return std::min(start_.vertexSolver.recoverable, kMostRecovered * own);
}

/// What fabric has at the end of a step beyond what pins, solids and liquid gave it, and what it owes from before, is taken from its motion; what
/// that cannot pay it goes on to owe. Returns the changes of the step, where they are booked.
std::optional<EnergyChanges> VertexSolver::dissipateGain(double h, FabricState& state)
{
    std::optional<EnergyChanges> changes;
    if (booksEnergy_) changes = energyChanges(h, state);
    const double given = changes ? externalWork(*changes) : workOutside(h, state);
    const double due = start_.vertexSolver.owed + energies(state, gravity_).total() - startEnergies_.total() - given - recovered(state, groups_) -
                       aheadOfWay(h, state, groups_);
    const double paid = payOwed(due, fabric_, groups_, mass_, state);
    if (changes) (*changes)[EnergyChange::Implicit] -= paid;
    return changes;
}

/// Where Newton has not come to a solution, or contact has come about that it did not see, what that gave is taken from the motion of
/// fabric that nothing drives.
void VertexSolver::removeSpuriousGain(const Part& part)
{
    const double h = part.h;
    FabricState& state = part.state;
    const double before = isSecondOrder_ ? start_.vertexSolver.owed : 0.0, back = recovered(state, groups_);
    std::vector<Vec3> byLiquid(loads_ ? state.v.size() : 0);  // the same however much of the way is made [g cm/s]
    for (std::size_t v = 0; v < byLiquid.size(); ++v) byLiquid[v] = h / wholeStep_ * (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]));
    const auto due = [&] {
        const double given = parallelSum(byLiquid.size(), [&](std::size_t v) { return byLiquid[v].dot(workingVelocity(v, state)); });
        return before + energies(state, gravity_).total() - startEnergies_.total() - given - back - aheadOfWay(h, state, groups_);
    };
    const auto canPay = [&] { return due() <= ownKinetic(fabric_, groups_, mass_, state) + bearableGain(h); };
    const auto pay = [&] {
        slowDown(due(), fabric_, groups_, mass_, state);
        if (isSecondOrder_) state.vertexSolver.owed = std::clamp(due(), 0.0, bearableGain(h));
    };
    if (canPay()) {
        pay();
        return;
    }
    SubstepDisplacement displacement{std::vector<Vec3>(state.x.size()), {}, groups_.drifts(mass_, state.v), std::vector<double>(state.theta.size())};
    for (std::size_t v = 0; v < state.x.size(); ++v) displacement.moves[v] = state.x[v] - start_.x[v];
    for (std::size_t e = 0; e < state.theta.size(); ++e) displacement.turns[e] = state.theta[e] - start_.theta[e];
    displacement.drift = groups_.drifts(mass_, displacement.moves);
    // Where all of the motion does not pay for it, only a part of the way can be, but for the drift of what nothing holds.
    for (const double share : {0.5, 0.25, 0.125, 0.0}) {
        if (canPay()) break;
        applyFraction(part, displacement, share);
    }
    if (!canPay()) {  // what is in the way of the drift deforms it: all stays where it was, and keeps the momentum of its drift
        std::ranges::fill(displacement.drift, Vec3::Zero());
        std::ranges::fill(displacement.driftVelocity, Vec3::Zero());
        applyFraction(part, displacement, 0.0);
        const std::vector<Vec3> drift = groups_.drifts(mass_, start_.v);
        for (std::size_t v = 0; v < state.v.size(); ++v)
            if (!fabric_.pinned[v]) state.v[v] += drift[groups_.pieceOf(static_cast<int>(v))];
    }
    pay();
}

/// Moves from the start of the attempt a share of the way against the drift, and all of the drift.
void VertexSolver::applyFraction(const Part& part, const SubstepDisplacement& displacement, double share)
{
    FabricState& state = part.state;
    const double lastFraction = state.vertexSolver.lastFraction;
    state = start_;
    state.vertexSolver.lastFraction = lastFraction;
    state.springStep = springStep_;
    solidLimiter_.moveTo(part.t, part.t + part.h);
    if (contact_) contact_->beginStep(state.x, mass_, stepOfInertia(part.h), springStep_, start_.vertexSolver.onFabric);
    for (std::size_t v = 0; v < displacement.moves.size(); ++v) {
        const Vec3& drift = displacement.drift[groups_.pieceOf(static_cast<int>(v))];
        move_[v] = drift + share * (displacement.moves[v] - drift);
    }
    commit(limit(state, part.report, part.clock), state, part.clock);
    solidLimiter_.rest();
    for (std::size_t e = 0; e < displacement.turns.size(); ++e) state.theta[e] += share * displacement.turns[e];
    findMeanRates(part.h, state);
    if (isSecondOrder_)
        for (std::size_t v = 0; v < state.v.size(); ++v) {
            const int piece = groups_.pieceOf(static_cast<int>(v));
            state.v[v] += displacement.driftVelocity[piece] - displacement.drift[piece] / part.h;
        }
    storeContacts(part.h, state);
}

/// What touches where a step begins and ends, and not only where Newton looked last: contact that a small move has brought about.
void VertexSolver::updateContacts(double h, FabricState& state, StageClock& clock)
{
    if (!startIsChecked_) {
        findContacts(h, start_.x, {}, clock);
        undetectedAtStart_ = std::max(0.0, contactEnergy(h, start_.x, start_).sum() - start_.stored.sum());
        startIsChecked_ = true;
    }
    findContacts(h, state.x, {}, clock);
    hasMovedSinceDetection_ = false;
    storeContacts(h, state);
}

}  // namespace sim
