#include "sim/fabric/pins.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <array>
#include <cmath>

// What acted on the fabric in an attempt that stands, by the forces of its last iteration: contact's are known pair by pair, those of pins are
// what the balance of a held vertex wants. What iterations have left of that balance is nobody's yet (MomentumBudget).

namespace sim {

/// Newton's last move, as far as contact has been looked at before it [cm].
Vec3 VertexSolver::solvedMove(int vertex) const { return hasMovedSinceDetection_ ? system_.move(vertex) : Vec3::Zero().eval(); }

/// Gradient of a pair of fabric by its separation [dyn]: contact is so stiff that where a move did not come quite as far as Newton's
/// the force at the state is another than the one it reckoned with.
Vec3 VertexSolver::forceAtEnd(std::size_t contact) const
{
    const Vec3& normal = contacts_->pairs().normal[contact];
    const Vec3 change = contacts_->pairs().slip(contact, [&](int v) { return solvedMove(v); });
    const Vec3 along = normal.dot(change) * normal;
    return contacts_->pairs().force[contact] + contacts_->pairs().stiffness[contact] * along +
           contacts_->pairs().frictionStiffness[contact] * (change - along);
}

/// Gradient of a point on a solid by its place at the end [dyn]: what acted there, and its stiffness times what Newton has left to go.
Vec3 VertexSolver::forceAtEnd(const ObstacleContact& contact) const
{
    const std::array<int, 3> v = contact.vertices();
    const std::array<double, 3> share = contact.shares();
    Vec3 change = Vec3::Zero();
    for (int k = 0; k < 3; ++k) change += share[k] * solvedMove(v[k]);
    return contact.gradient + contact.stiffness * change;
}

void VertexSolver::reportForces(double h, const FabricState& state) const
{
    reportContacts(h, state);
    if (solidLimiterActed_) reportSolidLimiter(h, state);
    if (!fabric_.pins.vertex.empty()) reportPins(h, state);
}

/// Penalty and friction, on solids and between pieces of the scene.
void VertexSolver::reportContacts(double h, const FabricState& state) const
{
    for (const ObstacleContact& contact : touching()) {
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        const Vec3 place = share[0] * state.x[v[0]] + share[1] * state.x[v[1]] + share[2] * state.x[v[2]];
        forces_->touch(fabric_.pieceOf(v[0]), obstacles_.inScene(contact.between[1]), Impulse::at(place, h * forceAtEnd(contact)));
    }
    for (std::size_t i = 0; contacts_ && i < contacts_->pairs().size(); ++i) {
        const std::array<int, 4>& v = contacts_->pairs().vertices[i];
        const int first = fabric_.pieceOf(v[0]), second = fabric_.pieceOf(v[contacts_->pairs().firstSide[i]]);
        if (first == second) continue;
        const std::array<Vec3, 4> impulses = contacts_->pairs().forcesOnVertices(i, -h * forceAtEnd(i));
        Impulse onFirst;
        for (int k = 0; k < contacts_->pairs().firstSide[i]; ++k) onFirst += Impulse::at(state.x[v[k]], impulses[k]);
        forces_->meet(first, second, onFirst);
    }
}

/// What solids made of the last move, which velocities follow.
void VertexSolver::reportSolidLimiter(double h, const FabricState& state) const
{
    for (std::size_t v = 0; v < limitedMove_.size(); ++v) {
        if (limitedMove_[v].isZero(0.0)) continue;
        const Vec3 onObstacle = -mass_[v] / h * limitedMove_[v];
        forces_->touch(fabric_.pieceOf(static_cast<int>(v)), obstacles_.inScene(obstacles_.nearest(state.x[v])), Impulse::at(state.x[v], onObstacle));
    }
}

/// What a held vertex, or a held twist angle, would do if it were not.
void VertexSolver::reportPins(double h, const FabricState& state) const
{
    const std::vector<int>& pinned = fabric_.pins.vertex;
    const std::span<const double> gradient = system_.heldGradient();
    const double part = h / wholeStep_;
    for (std::size_t i = 0; i < pinned.size(); ++i) {
        const int v = pinned[i];
        Vec3 got = -impulseOfHolder(v, h, state, Vec3(gradient[3 * i], gradient[3 * i + 1], gradient[3 * i + 2]));
        if (loads_) got += part * (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]));
        forces_->pins[fabric_.pins.motion[i]] += Impulse::at(state.x[v], got);
    }
    std::size_t held = 3 * pinned.size();
    for (std::size_t e = 0; e < fabric_.edges.size() && held < gradient.size(); ++e) {
        if (!fabric_.edges.twistHeld[e]) continue;
        const double torque = -gradient[held++];
        if (const auto pin = pinOfEdge(fabric_, static_cast<int>(e)))
            forces_->pins[fabric_.pins.motion[*pin]].angular += h * torque * state.tangent[e];
    }
}

void VertexSolver::reportLiquid(const FabricState& state) const
{
    for (std::size_t v = 0; v < state.v.size(); ++v) {
        const Vec3 got = loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]);
        if (!got.isZero(0.0)) forces_->fabrics[fabric_.pieceOf(static_cast<int>(v))].liquid += Impulse::at(state.x[v], got);
    }
}

}  // namespace sim
