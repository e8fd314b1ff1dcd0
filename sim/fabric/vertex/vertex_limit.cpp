#include "sim/core/parallel.h"
#include "sim/fabric/solids/bisect_interval.h"
#include "sim/fabric/vertex/vertex_solver.h"

// Moves that take fabric through neither itself nor solids.

namespace sim {

namespace {

constexpr int kMostTurns = 8;  ///< turns of solids and of pairs in limiting a move

}  // namespace

/// Makes move_ safe, if it can.
VertexSolver::LimitedMove VertexSolver::limit(const FabricState& state, FabricReport& report, StageClock& clock)
{
    if (!contact_) return {.isSafe = true, .betweenFabric = {}};
    const LimitReport before = limits_;
    const LimitedMove limited = limitAlternately(state, clock);
    report.candidateListBuilds += limits_.candidateListBuilds - before.candidateListBuilds;
    report.globalScalings += limits_.globalScalings - before.globalScalings;
    return limited;
}

/// Makes move_ safe from solids.
SolidLimiter::Limited VertexSolver::limitAtSolids(const FabricState& state)
{
    if (solidLimiter_.empty() || !forces_) return solidLimiter_.limit(state.x, mass_, move_, solidLimits_);
    unlimitedMove_ = move_;
    const SolidLimiter::Limited limited = solidLimiter_.limit(state.x, mass_, move_, solidLimits_);
    if (limited.moves == SolidLimiter::Limited::Moves::Changed)
        parallelFor(move_.size(), 4096, [&](std::size_t v) { limitedMove_[v] += move_[v] - unlimitedMove_[v]; });
    return limited;
}

/// Solids and pairs of fabric each change what the other has left safe, until one has nothing more to change.
VertexSolver::LimitedMove VertexSolver::limitAlternately(const FabricState& state, StageClock& clock)
{
    LimitedMove move;
    solidLimiterActed_ = false;
    if (forces_ && !solidLimiter_.empty()) limitedMove_.assign(move_.size(), Vec3::Zero());
    for (int turn = 0; turn < kMostTurns; ++turn) {
        clock.start(Stage::FabricContact);
        const SolidLimiter::Limited limited = limitAtSolids(state);
        if (limited.moves == SolidLimiter::Limited::Moves::Unsafe) return move;
        solidLimiterActed_ = solidLimiterActed_ || limited.moves == SolidLimiter::Limited::Moves::Changed;
        move.isSafe = limited.moves == SolidLimiter::Limited::Moves::Unchanged && turn > 0;
        if (move.isSafe) return move;
        move.betweenFabric = contact_->limit(state.x, move_, limits_, clock);
        move.isSafe = !move.betweenFabric->wereChanged() || !limited.isNear;
        if (move.isSafe) return move;
    }
    clock.start(Stage::FabricContact);
    const SolidLimiter::SafeShare safe = solidLimiter_.safePart(state.x, move_);
    move.isSafe = safe.part >= 1.0 || !safe.isDriven;
    if (safe.part >= 1.0) return move;
    // A part of each straight move is as safe, if solids rest.
    if (!move.isSafe) {
        ++solidLimits_.left;
        return move;
    }
    parallelFor(move_.size(), 4096, [&](std::size_t v) { move_[v] *= kSafeShare * safe.part; });
    ++limits_.globalScalings;
    return move;
}

/// Moves the fabric by move_ while solids go on, in halves of the time where it has no safe way in one; false if it should
/// be redone in halves of the whole step.
bool VertexSolver::followSolids(const Part& part, bool isLast)
{
    const double h = part.h;
    wholeMove_ = move_;
    const auto go = [&](double begin, double length) {
        solidLimiter_.moveTo(begin, begin + length);
        parallelFor(move_.size(), 4096, [&](std::size_t v) { move_[v] = length / h * wholeMove_[v]; });
        const LimitedMove limited = limit(part.state, part.report, part.clock);
        if (limited.isSafe) commit(limited, part.state, part.clock);
        return limited.isSafe;
    };
    const bool hasGot = solids::bisectInterval(part.t, h, isLast ? SolidLimiter::kMostHalvings : 0, go);
    if (!hasGot && isLast) solidLimiter_.throwNoSafeMove(part.state.x, move_);
    solidLimiter_.rest();
    return hasGot;
}

}  // namespace sim
