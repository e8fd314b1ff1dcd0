#include "sim/fabric/energies.h"
#include "sim/fabric/owed_energy.h"
#include "sim/fabric/pins.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sim {

/// Work of contact along the move from start_, by what the last iteration reckoned with: contact is so stiff that where the move did not
/// come quite there its force at the state is another. What it adds to the gradient is that force.
void VertexSolver::bookContacts(const FabricState& state, EnergyChanges& changes, std::span<Vec3> gradient) const
{
    const auto move = [&](int v) -> Vec3 { return state.x[v] - start_.x[v]; };
    for (std::size_t i = 0; contacts_ && i < contacts_->size(); ++i) {
        const std::array<int, 4>& v = contacts_->vertices[i];
        const Vec3& normal = contacts_->normal[i];
        Vec3 apart = Vec3::Zero();
        for (int k = 0; k < 4; ++k) apart += contacts_->slipJacobian(i, k) * move(v[k]);
        const Vec3 force = forceAtEnd(i);
        const Vec3 push = normal.dot(force) * normal;
        changes[EnergyChange::Contact] -= push.dot(apart);
        changes[EnergyChange::Friction] -= (force - push).dot(apart);
        const std::array<Vec3, 4> onVertices = contacts_->forcesOnVertices(i, force);
        for (int k = 0; k < 4; ++k) gradient[v[k]] += onVertices[k];
    }
    for (const ObstacleContact& contact : touching_) {
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
    for (std::size_t i = 0; contacts_ && i < contacts_->size(); ++i) hold(contacts_->vertices[i]);
    for (const ObstacleContact& contact : touching_) hold(contact.vertices());
    return held;
}

/// Elastic and viscous gradient at the state, over a step of a length [s] (internalGradient).
InternalGradient VertexSolver::gradientAt(const FabricState& state, double length) const
{
    return internalGradient(fabric_, state, length, system_.unknowns(), system_.rods(), system_.shells());
}

/// Adds the work of pins, solids, contact and liquid from start_ to the state, by the forces at the state: backward Euler's are those at the end
/// of a step. What contact adds to the gradient is its force.
void VertexSolver::bookOutside(double h, const Vec3& gravity, const FabricState& state, InternalGradient& gradient, EnergyChanges& changes) const
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
        changes[EnergyChange::Drag] += byLiquid.dot(state.v[v]);
        if (!fabric_.pinned[v] && !isHeld[v] && nearestPin_[v] < 0) continue;
        const Vec3 byHolder = mass_[v] * (state.v[v] - start_.v[v] - h * gravity) - byLiquid + h * gradient.byPosition[v];
        if (!fabric_.pinned[v] && !isHeld[v]) {
            // Forces within the fabric sum up to nothing, and so do their errors: what Newton has left of the balance of a free vertex, pins have.
            changes[EnergyChange::Pins] += byHolder.dot(state.v[nearestPin_[v]]);
            continue;
        }
        // Solids at rest do no work on what they hold: what Newton has left of the balance there is the step's own.
        const EnergyChange bySolid = solidsMove_ ? EnergyChange::Obstacles : EnergyChange::Implicit;
        changes[fabric_.pinned[v] ? EnergyChange::Pins : bySolid] += byHolder.dot(state.v[v]);
    }
    for (std::size_t e = 0; e < state.omega.size(); ++e) {
        if (!fabric_.edges.twistHeld[e]) continue;
        const double inertia = twistInertia(fabric_, state.absorbed, e), faster = state.omega[e] - start_.omega[e];
        const double turn = pinTurn(fabric_, restReference_, startTime_, startTime_ + h, state, static_cast<int>(e));
        changes[EnergyChange::Pins] += (inertia * faster / h + gradient.byAngle[e]) * turn;
    }
}

/// What pins, solids and liquid gave from start_ to the state [erg].
double VertexSolver::workOutside(double h, const Vec3& gravity, const FabricState& state) const
{
    EnergyChanges changes;
    InternalGradient gradient = gradientAt(state, h);
    bookOutside(h, gravity, state, gradient, changes);
    return externalWork(changes);
}

/// Work of all that acted from start_ to the state.
EnergyChanges VertexSolver::energyChanges(double h, const Vec3& gravity, const FabricState& state) const
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
    changes[EnergyChange::Implicit] = energies(state, gravity).elastic() - startEnergies_.elastic() - elastic;
    for (std::size_t v = 0; v < state.v.size(); ++v) changes[EnergyChange::Implicit] -= 0.5 * mass_[v] * (state.v[v] - start_.v[v]).squaredNorm();
    for (std::size_t e = 0; e < state.omega.size(); ++e) {
        const double faster = state.omega[e] - start_.omega[e];
        changes[EnergyChange::Implicit] -= 0.5 * twistInertia(fabric_, state.absorbed, e) * faster * faster;
    }
    bookOutside(h, gravity, state, gradient, changes);
    return changes;
}

}  // namespace sim
