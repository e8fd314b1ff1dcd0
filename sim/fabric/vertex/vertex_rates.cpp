#include "sim/core/parallel.h"
#include "sim/fabric/held.h"
#include "sim/fabric/pins.h"
#include "sim/fabric/vertex/vertex_solver.h"

#include <algorithm>
#include <array>
#include <numbers>

// Velocities by which the state came from that at the start of an attempt, and what the fabric's own forces did.

namespace sim {

/// Length of a step by which springs of contact and friction know how far it takes a mass: h where that is h² F/m.
double VertexSolver::stepOfInertia(double h) const { return isSecondOrder_ ? h / std::numbers::sqrt2 : h; }

/// How far the mean of forces is behind the last of them, at the start of a step of h, relative to the last step: it is by a step.
double VertexSolver::meanForceLag(double h) const
{
    constexpr double kMost = 2.0;  // in steps that grow faster what the mean remembers of noise would
    return start_.vertexSolver.lastStep > 0.0 ? std::min(kMost, h / start_.vertexSolver.lastStep) : 0.0;
}

/// A vertex at the start of the attempt.
bossak::Vertex VertexSolver::bossakOf(std::size_t v, double h) const
{
    bossak::Vertex at{mass_[v], Vec3::Zero(), Vec3::Zero(), start_.v[v], meanForceBefore(v, h), gravity_, h};
    if (loads_) {
        at.drag = h / wholeStep_ * loads_->drag[v];
        at.impulse = h / wholeStep_ * loads_->impulse[v];
    }
    return at;
}

/// What made another of Newton's last move, as a force that acts from the beginning of the step [dyn].
Vec3 VertexSolver::limiterForce(std::size_t v, double h) const
{
    if (fabric_.pinned[v]) return Vec3::Zero();
    return inertia_[v].cwiseProduct(move_[v] - system_.move(static_cast<int>(v))) / (2.0 * h * h);
}

/// All contacts with what they do to their vertices, by their forces as Newton's last move reckoned with them; and the sum of those on each vertex.
void VertexSolver::findContactForces(double h, std::vector<Vec3>& sum)
{
    const std::size_t pairs = contacts_ ? contacts_->pairs().size() : 0;
    acting_.resize(pairs + touching().size());
    parallelFor(pairs, 256, [&](std::size_t i) {
        acting_[i] = {contacts_->pairs().vertices[i], contacts_->pairs().forcesOnVertices(i, -forceAtEnd(i)), Vec3::Zero()};
    });
    parallelFor(touching().size(), 256, [&](std::size_t i) {
        const ObstacleContact& contact = touching()[i];
        const std::array<int, 3> v = contact.vertices();
        const std::array<double, 3> share = contact.shares();
        const Vec3 force = -forceAtEnd(contact), place = share[0] * start_.x[v[0]] + share[1] * start_.x[v[1]] + share[2] * start_.x[v[2]];
        acting_[pairs + i] = {{v[0], v[1], v[2], v[0]},
                              {share[0] * force, share[1] * force, share[2] * force, Vec3::Zero()},
                              obstacles_.moved(contact.between[1], place) / h};
    });
    sum.assign(start_.x.size(), Vec3::Zero());
    for (const ActingContact& contact : acting_)
        for (int k = 0; k < 4; ++k) sum[contact.vertices[k]] += contact.force[k];
}

/// Part of a contact's force that acts as an impulse: what has come about in the step, as far as it stops those that approached each other, together
/// with what else acts on their vertices. A contact lasts as far as one of its vertices has been pressed so in the steps before, by whatever it
/// touched, so that what slides from edge to edge goes on pressing.
/// @param all  forces of contact on each vertex [dyn]
double VertexSolver::abruptShare(double h, const ActingContact& contact, std::span<const Vec3> all, const FabricState& state) const
{
    const std::vector<Vec3>& before = start_.vertexSolver.meanContactForce;
    if (before.empty()) return 0.0;  // nothing is known of what began in contact
    double lasting = 0.0, approach = 0.0, answer = 0.0;
    for (int k = 0; k < 4; ++k) {
        const int v = contact.vertices[k];
        const Vec3& force = contact.force[k];
        const double along = all[v].dot(force);
        if (along > 0.0) lasting = std::max(lasting, before[v].dot(force) / along);
        const Vec3 velocity = fabric_.pinned[v] ? Vec3((state.x[v] - start_.x[v]) / h) : start_.v[v];
        approach -= force.dot(velocity - contact.velocity);
        if (!fabric_.pinned[v]) answer += std::max(force.squaredNorm(), along) / mass_[v];
    }
    if (!(approach > 0.0 && answer > 0.0 && lasting < 1.0)) return 0.0;
    return std::min(1.0 - lasting, 2.0 * approach / (answer * h));
}

/// Half of the forces of contact that act as impulses, and of what made another of Newton's last move; the rest of contact lasts. Each contact gives
/// to both sides alike.
void VertexSolver::findAbrupt(double h, FabricState& state)
{
    abrupt_.resize(state.x.size());
    parallelFor(abrupt_.size(), 1024, [&](std::size_t v) { abrupt_[v] = limiterForce(v, h); });
    std::vector<Vec3>& lasting = state.vertexSolver.meanContactForce;
    const std::vector<Vec3>& before = start_.vertexSolver.meanContactForce;
    findContactForces(h, lasting);
    parallelFor(acting_.size(), 256, [&](std::size_t i) { acting_[i].abrupt = abruptShare(h, acting_[i], lasting, state); });
    for (const ActingContact& contact : acting_) {
        if (!(contact.abrupt > 0.0)) continue;
        for (int k = 0; k < 4; ++k) {
            abrupt_[contact.vertices[k]] += 0.5 * contact.abrupt * contact.force[k];
            lasting[contact.vertices[k]] -= contact.abrupt * contact.force[k];
        }
    }
    if (before.empty()) return;
    parallelFor(lasting.size(), 4096, [&](std::size_t v) { lasting[v] = 0.5 * (before[v] + lasting[v]); });
}

/// After Newton's last move.
void VertexSolver::findRates(double h, FabricState& state)
{
    if (isSecondOrder_) findSecondOrderRates(h, state);
    else {
        findMeanRates(h, state);
        FabricState::VertexSolverPart& now = state.vertexSolver;  // a next step of second order is a first one
        now.force.clear(), now.meanForce.clear(), now.torque.clear(), now.meanTorque.clear(), now.meanContactForce.clear();
        now.lastStep = 0.0;
    }
}

/// Rates of backward Euler, and of a state to which no forces led: those of the way.
void VertexSolver::findMeanRates(double h, FabricState& state) const
{
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) {
        state.v[v] = (state.x[v] - start_.x[v]) / h;
        state.acceleration[v] = inertia_[v].cwiseProduct(state.x[v] - free_[v]) / (h * h * mass_[v]);
        state.held[v] = fabric_.pinned[v] ? Vec3(Vec3::Ones()) : heldShare(state.acceleration[v], (state.v[v] - start_.v[v]) / h);
    });
    parallelFor(freeAngle_.size(), 4096, [&](std::size_t e) { state.omega[e] = (state.theta[e] - start_.theta[e]) / h; });
}

/// Pins have the velocity of their way, and remember what the fabric would do to them.
void VertexSolver::findSecondOrderRates(double h, FabricState& state)
{
    findAbrupt(h, state);
    const FabricState::VertexSolverPart& before = start_.vertexSolver;
    FabricState::VertexSolverPart& now = state.vertexSolver;
    now.force.resize(fabric_.vertexCount()), now.meanForce.resize(fabric_.vertexCount());
    now.torque.resize(freeAngle_.size()), now.meanTorque.resize(freeAngle_.size());
    now.lastStep = h;
    parallelFor(fabric_.vertexCount(), 1024, [&](std::size_t v) {
        const Vec3 move = state.x[v] - start_.x[v];
        if (fabric_.pinned[v]) {
            state.v[v] = move / h;
            state.acceleration[v].setZero();
            state.held[v].setOnes();
            return;
        }
        const bossak::Vertex at = bossakOf(v, h);
        const bossak::Rates rates = bossak::ratesOf(at, move, abrupt_[v]);
        state.v[v] = rates.velocity;
        now.meanForce[v] = rates.force;
        now.force[v] = 2.0 * rates.force - at.force;
        state.acceleration[v] = rates.own;
        state.held[v] = heldShare(rates.own, (state.v[v] - start_.v[v]) / h);
    });
    const std::span<const double> gradient = system_.heldGradient();
    for (std::size_t i = 0; i < fabric_.pins.vertex.size(); ++i) {
        const int v = fabric_.pins.vertex[i];
        now.force[v] = -Vec3(gradient[3 * i], gradient[3 * i + 1], gradient[3 * i + 2]);
        now.meanForce[v] = 0.5 * (meanForceBefore(v, h) + now.force[v]);
    }
    const double lag = meanForceLag(h);
    parallelFor(freeAngle_.size(), 4096, [&](std::size_t e) {
        const double turn = state.theta[e] - start_.theta[e];
        now.torque[e] = now.meanTorque[e] = 0.0;
        if (fabric_.edges.twistHeld[e]) {
            state.omega[e] = turn / h;
            return;
        }
        const double mean = before.torque.empty() ? 0.0 : before.torque[e] + lag * (before.meanTorque[e] - before.torque[e]);
        const auto [rate, torque] = bossak::twistRatesOf(turn, start_.omega[e], mean, twistInertia(fabric_, state.absorbed, e), h);
        state.omega[e] = rate;
        now.meanTorque[e] = torque;
        now.torque[e] = 2.0 * torque - mean;
    });
}

}  // namespace sim
