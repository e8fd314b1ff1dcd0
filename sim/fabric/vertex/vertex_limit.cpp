#include "sim/core/parallel.h"
#include "sim/fabric/solids/in_halves.h"
#include "sim/fabric/vertex/vertex_solver.h"

// Moves that take fabric through neither itself nor solids.

namespace sim {

namespace {

constexpr int kMostTurns = 8;  ///< of solids and of pairs in limiting a move

}  // namespace

/// Makes move_ safe; false, which it is only while solids move, if it could not.
bool VertexSolver::limit(const FabricState& state, FabricReport& report, StageClock& clock)
{
    if (!contact_) return true;
    const LimitReport before = limits_;
    const bool isSafe = limitInTurn(state, clock);
    report.listBuilds += limits_.listBuilds - before.listBuilds;
    report.scalings += limits_.scalings - before.scalings;
    return isSafe;
}

/// Makes move_ safe from solids.
SolidGuard::Limited VertexSolver::keepFromSolids(const FabricState& state)
{
    if (guard_.empty() || !forces_) return guard_.limit(state.x, mass_, move_, guarded_);
    unguarded_ = move_;
    const SolidGuard::Limited limited = guard_.limit(state.x, mass_, move_, guarded_);
    if (limited == SolidGuard::Limited::Changed) parallelFor(move_.size(), 4096, [&](std::size_t v) { guardMove_[v] += move_[v] - unguarded_[v]; });
    return limited;
}

/// Solids and pairs of fabric each change what the other has left safe, until one has nothing more to change.
bool VertexSolver::limitInTurn(const FabricState& state, StageClock& clock)
{
    guardActed_ = false;
    if (forces_ && !guard_.empty()) guardMove_.assign(move_.size(), Vec3::Zero());
    for (int turn = 0; turn < kMostTurns; ++turn) {
        clock.start(Stage::FabricContact);
        const SolidGuard::Limited limited = keepFromSolids(state);
        if (limited == SolidGuard::Limited::Unsafe) return false;
        guardActed_ = guardActed_ || limited == SolidGuard::Limited::Changed;
        if (limited == SolidGuard::Limited::Unchanged && turn > 0) return true;
        const bool hasChanged = contact_->limit(state.x, move_, limits_, clock);
        if (!hasChanged || !guard_.isNear()) return true;
    }
    clock.start(Stage::FabricContact);
    const double part = guard_.safePart(state.x, move_);
    if (part >= 1.0) return true;
    // A part of each straight move is as safe, if solids rest.
    if (guard_.anyMoves()) {
        ++guarded_.left;
        return false;
    }
    constexpr double kSpare = 0.95;
    parallelFor(move_.size(), 4096, [&](std::size_t v) { move_[v] *= kSpare * part; });
    ++limits_.scalings;
    return true;
}

/// Moves the fabric by move_ while solids go on, in halves of the time where it has no safe way in one; false if it should
/// be redone in halves of the whole step.
bool VertexSolver::followSolids(const Part& part, bool isLast)
{
    const double h = part.h;
    wholeMove_ = move_;
    const auto go = [&](double begin, double length) {
        guard_.moveTo(begin, begin + length);
        parallelFor(move_.size(), 4096, [&](std::size_t v) { move_[v] = length / h * wholeMove_[v]; });
        if (!limit(part.state, part.report, part.clock)) return false;
        commit(part.state, part.clock);
        return true;
    };
    const bool hasGot = solids::inHalves(part.t, h, isLast ? SolidGuard::kMostHalvings : 0, go);
    if (!hasGot && isLast) guard_.refuse();
    guard_.rest();
    return hasGot;
}

}  // namespace sim
