#include "sim/fabric/energies.h"
#include "sim/fabric/owed_energy.h"
#include "sim/fabric/pins.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace sim {

/// Work of contact along the move from start_, by what the last iteration reckoned with: contact is so stiff that where the move did not
/// come quite there its force at the state is another. What it adds to the gradient is that force.
void VertexSolver::bookContacts(const FabricState& state, EnergyChanges& changes, std::span<Vec3> gradient) const
{
    const auto move = [&](int v) -> Vec3 { return state.x[v] - start_.x[v]; };
    for (std::size_t i = 0; contacts_ && i < contacts_->pairs().size(); ++i) {
        const std::array<int, 4>& v = contacts_->pairs().vertices[i];
        const Vec3& normal = contacts_->pairs().normal[i];
        const Vec3 apart = contacts_->pairs().slip(i, move);
        const Vec3 force = forceAtEnd(i);
        const Vec3 push = normal.dot(force) * normal;
        changes[EnergyChange::Contact] -= push.dot(apart);
        changes[EnergyChange::Friction] -= (force - push).dot(apart);
        const std::array<Vec3, 4> onVertices = contacts_->pairs().forcesOnVertices(i, force);
        for (int k = 0; k < 4; ++k) gradient[v[k]] += onVertices[k];
    }
    for (const ObstacleContact& contact : touching()) {
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        Vec3 moved = Vec3::Zero();
        for (int k = 0; k < 3; ++k) moved += share[k] * move(v[k]);
        const Vec3 force = forceAtEnd(contact);
        changes[EnergyChange::Obstacles] -= force.dot(moved);
        for (int k = 0; k < 3; ++k) gradient[v[k]] += share[k] * force;
    }
}

/// Vertices that solids hold, as pins do: what the limiter made of Newton's last move where they took a hand in it, and what hangs on those by
/// edges, faces and contacts, whose forces are out of balance by as much.
std::vector<char> VertexSolver::heldBySolids() const
{
    std::vector<char> stopped(fabric_.vertexCount(), 0);
    if (!solidLimiterActed_) return stopped;
    for (std::size_t v = 0; v < stopped.size(); ++v) stopped[v] = move_[v] != system_.move(static_cast<int>(v));
    std::vector<char> held = stopped;
    const auto hold = [&](const auto& vertices) {
        if (std::ranges::none_of(vertices, [&](int v) { return stopped[v] != 0; })) return;
        for (int v : vertices) held[v] = 1;
    };
    for (int s = 0; s < fabric_.strands.count(); ++s)  // bending reaches over two edges
        for (int j = 0; j + 2 < fabric_.strands.size(s); ++j)
            hold(std::array<int, 3>{fabric_.strands.vertex(s, j), fabric_.strands.vertex(s, j + 1), fabric_.strands.vertex(s, j + 2)});
    for (const Vec2i& edge : fabric_.edges.vertices) hold(edge);
    for (const Vec3i& face : fabric_.faces.vertices) hold(face);
    for (std::size_t i = 0; contacts_ && i < contacts_->pairs().size(); ++i) hold(contacts_->pairs().vertices[i]);
    for (const ObstacleContact& contact : touching()) hold(contact.vertices());
    return held;
}

/// Elastic and viscous gradient at the state, over a step of a length [s] (internalGradient).
InternalGradient VertexSolver::gradientAt(const FabricState& state, double length) const
{
    return internalGradient(fabric_, state, length, system_.unknowns(), *elasticStep_);
}

/// What a vertex needs beyond the fabric's own forces and the liquid to have come to its velocity [g cm/s].
/// @param gradient  elastic, viscous and of contact, at the state [dyn]
Vec3 VertexSolver::impulseOfHolder(std::size_t v, double h, const FabricState& state, const Vec3& gradient) const
{
    const Vec3 gained = mass_[v] * (state.v[v] - start_.v[v]);
    if (!isSecondOrder_) return gained - h * (mass_[v] * gravity_ - gradient);
    const Vec3 abrupt = abrupt_[v] - limiterForce(v, h);
    return gained - h * mass_[v] * gravity_ - 0.25 * h * (meanForceBefore(v, h) - 3.0 * gradient - 2.0 * abrupt);
}

/// Work of what holds a vertex by an impulse [erg]: on the way that the vertex went, but for what changes the kinetic energy.
double VertexSolver::workOfHolder(std::size_t v, double h, const FabricState& state, const Vec3& impulse) const
{
    if (!isSecondOrder_) return impulse.dot(state.v[v]);
    const Vec3 mean = (state.x[v] - start_.x[v]) / h;
    const Vec3 gained = mass_[v] * (state.v[v] - start_.v[v]);
    return impulse.dot(mean) + gained.dot(workingVelocity(v, state) - mean);
}

/// Work of a pin with the scheme of second order [erg]: elastic energy changes by the mean of the forces at both ends of the way.
/// @param before  the fabric's own force at the start of the step [dyn]
double VertexSolver::workOfPin(std::size_t v, double h, const FabricState& state, const Vec3& byLiquid, const Vec3& gradient,
                               const Vec3& before) const
{
    const Vec3 way = state.x[v] - start_.x[v];
    const Vec3 force = 0.5 * (before - gradient);
    const double kinetic = 0.5 * mass_[v] * (state.v[v].squaredNorm() - start_.v[v].squaredNorm());
    return kinetic - way.dot(force + mass_[v] * gravity_ + byLiquid / h);
}

void VertexSolver::bookPins(double h, const FabricState& state, std::span<const Vec3> gradient, EnergyChanges& changes)
{
    const std::vector<Vec3>& before = start_.vertexSolver.force;
    pinForce_.resize(fabric_.pins.vertex.size());
    for (std::size_t i = 0; i < pinForce_.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        pinForce_[i] = -gradient[v];
        Vec3 byLiquid = Vec3::Zero();
        if (loads_) byLiquid = h / wholeStep_ * (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]));
        changes[EnergyChange::Pins] += workOfPin(v, h, state, byLiquid, gradient[v], before.empty() ? pinForce_[i] : before[v]);
    }
}

/// Adds the work of pins, solids, contact and liquid from start_ to the state, by the forces at the state: backward Euler's are those at the end
/// of a step. What contact adds to the gradient is its force.
void VertexSolver::bookOutside(double h, const FabricState& state, InternalGradient& gradient, EnergyChanges& changes)
{
    bookContacts(state, changes, gradient.byPosition);
    changes[EnergyChange::Contact] += state.stored.pressed - start_.stored.pressed;
    changes[EnergyChange::Friction] += state.stored.gripped - start_.stored.gripped;
    changes[EnergyChange::Obstacles] += state.stored.solids - start_.stored.solids;

    const double part = h / wholeStep_;
    const std::vector<char> isHeld = heldBySolids();
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        Vec3 byLiquid = Vec3::Zero();
        if (loads_) byLiquid = part * (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]));
        changes[EnergyChange::Drag] += byLiquid.dot(workingVelocity(v, state));
        if (!fabric_.pinned[v] && !isHeld[v] && nearestPin_[v] < 0) continue;
        const Vec3 byHolder = impulseOfHolder(v, h, state, gradient.byPosition[v]) - byLiquid;
        if (!fabric_.pinned[v] && !isHeld[v]) {
            // Forces within the fabric sum up to nothing, and so do their errors: what Newton has left of the balance of a free vertex, pins have.
            changes[EnergyChange::Pins] += byHolder.dot(state.v[nearestPin_[v]]);
            continue;
        }
        // Solids at rest do no work on what they hold: what Newton has left of the balance there is the step's own.
        const EnergyChange bySolid = solidsMove_ ? EnergyChange::Obstacles : EnergyChange::Implicit;
        if (isSecondOrder_ && fabric_.pinned[v]) continue;
        changes[fabric_.pinned[v] ? EnergyChange::Pins : bySolid] += workOfHolder(v, h, state, byHolder);
    }
    if (isSecondOrder_) bookPins(h, state, gradient.byPosition, changes);
    for (std::size_t e = 0; e < state.omega.size(); ++e) {
        if (!fabric_.edges.twistHeld[e]) continue;
        const double inertia = twistInertia(fabric_, state.absorbed, e), faster = state.omega[e] - start_.omega[e];
        const double turn = pinTurn(fabric_, restReference_, startTime_, startTime_ + h, state, static_cast<int>(e));
        changes[EnergyChange::Pins] += (inertia * faster / h + gradient.byAngle[e]) * turn;
    }
}

/// What pins, solids and liquid gave from start_ to the state [erg].
double VertexSolver::workOutside(double h, const FabricState& state)
{
    EnergyChanges changes;
    InternalGradient gradient = gradientAt(state, h);
    bookOutside(h, state, gradient, changes);
    return externalWork(changes);
}

/// Work of all that acted from start_ to the state.
EnergyChanges VertexSolver::energyChanges(double h, const FabricState& state)
{
    const auto along = [&](const InternalGradient& gradient) {
        double sum = 0.0;
        for (std::size_t v = 0; v < state.x.size(); ++v) sum += gradient.byPosition[v].dot(state.x[v] - start_.x[v]);
        for (std::size_t e = 0; e < state.theta.size(); ++e) sum += gradient.byAngle[e] * (state.theta[e] - start_.theta[e]);
        return sum;
    };
    EnergyChanges changes;
    InternalGradient gradient = gradientAt(state, h);
    const double elastic = along(gradientAt(state, std::numeric_limits<double>::infinity()));
    changes[EnergyChange::Damping] = elastic - along(gradient);
    if (isSecondOrder_) {
        bookOutside(h, state, gradient, changes);
        const double all = std::accumulate(changes.of.begin(), changes.of.end(), 0.0);
        changes[EnergyChange::Implicit] += energies(state, gravity_).total() - startEnergies_.total() - all;
        return changes;
    }
    changes[EnergyChange::Implicit] = energies(state, gravity_).elastic() - startEnergies_.elastic() - elastic;
    for (std::size_t v = 0; v < state.v.size(); ++v) changes[EnergyChange::Implicit] -= 0.5 * mass_[v] * (state.v[v] - start_.v[v]).squaredNorm();
    for (std::size_t e = 0; e < state.omega.size(); ++e) {
        const double faster = state.omega[e] - start_.omega[e];
        changes[EnergyChange::Implicit] -= 0.5 * twistInertia(fabric_, state.absorbed, e) * faster * faster;
    }
    bookOutside(h, state, gradient, changes);
    return changes;
}

}  // namespace sim
