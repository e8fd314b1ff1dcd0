#include "sim/fabric/vertex/vertex_solver.h"

#include <limits>

// What iterations have left of the balance of forces, what the limiter takes from moves, and halves of a step that each feel the liquid at another
// speed than it will be told: all of them are small, and all of them change the momentum of fabric that nothing holds.

namespace sim {

/// Which pieces of fabric acted on each other at the end of the attempt, and what held them.
void VertexSolver::findGroups(FabricGroups& groups) const
{
    for (std::size_t i = 0; contacts_ && i < contacts_->pairs().size(); ++i) groups.joinVertices(contacts_->pairs().vertices[i]);
    for (const ObstacleContact& contact : touching())
        for (int v : contact.vertices()) groups.hold(v);
    for (int v : solidLimits_.stopped) groups.hold(v);
}

/// Momentum of each piece at the start of the step.
void VertexSolver::findMomenta(const FabricState& state)
{
    momentum_.assign(groups_.pieces(), Vec3::Zero());
    for (std::size_t v = 0; v < state.v.size(); ++v) momentum_[groups_.pieceOf(static_cast<int>(v))] += mass_[v] * state.v[v];
}

/// Weight and the liquid alone change the momentum of a group that nothing holds: what else did in the step of length h [s] is taken from all
/// of its velocities alike.
void VertexSolver::conserveMomentum(double h, FabricState& state)
{
    if (!groups_.anyFree()) return;
    missing_.assign(groups_.pieces(), Vec3::Zero());
    groupInertia_.assign(groups_.pieces(), Vec3::Zero());
    correction_.assign(groups_.pieces(), Vec3::Zero());
    for (int piece = 0; piece < groups_.pieces(); ++piece)
        if (const int group = groups_.freeGroupOf(piece); group >= 0) missing_[group] += momentum_[piece];
    const auto groupOf = [&](std::size_t v) { return groups_.freeGroupOf(groups_.pieceOf(static_cast<int>(v))); };
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const int group = groupOf(v);
        if (group < 0) continue;
        missing_[group] += mass_[v] * (h * gravity_ - state.v[v]);
        groupInertia_[group] += Vec3::Constant(mass_[v]);
        if (!loads_) continue;
        missing_[group] += loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]);
        groupInertia_[group] += loads_->drag[v];
    }
    // Velocities come from places: what these are rounded by is no motion, and fabric at rest stays so.
    const double rounding = placeRounding_ / h;
    for (std::size_t group = 0; group < missing_.size(); ++group) {
        const Vec3 change = missing_[group].cwiseQuotient(groupInertia_[group].cwiseMax(std::numeric_limits<double>::min()));
        if (!(change.cwiseAbs().maxCoeff() < rounding)) correction_[group] = change;
    }
    for (std::size_t v = 0; v < state.v.size(); ++v)
        if (const int group = groupOf(v); group >= 0) state.v[v] += correction_[group];
    if (isSecondOrder_) conserveForces(state);
}

/// Forces on a group that nothing holds sum up to none, whatever its pieces remember of what they have parted from.
void VertexSolver::conserveForces(FabricState& state)
{
    for (std::vector<Vec3>* force : {&state.vertexSolver.force, &state.vertexSolver.meanForce}) {
        if (force->empty()) return;
        missing_.assign(groups_.pieces(), Vec3::Zero());
        groupInertia_.assign(groups_.pieces(), Vec3::Zero());
        const auto groupOf = [&](std::size_t v) { return groups_.freeGroupOf(groups_.pieceOf(static_cast<int>(v))); };
        for (std::size_t v = 0; v < force->size(); ++v) {
            const int group = groupOf(v);
            if (group < 0) continue;
            missing_[group] -= (*force)[v];
            groupInertia_[group] += Vec3::Constant(mass_[v]);
        }
        for (std::size_t v = 0; v < force->size(); ++v)
            if (const int group = groupOf(v); group >= 0) (*force)[v] += mass_[v] * missing_[group].cwiseQuotient(groupInertia_[group]);
    }
}

}  // namespace sim
