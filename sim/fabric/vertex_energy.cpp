#include "sim/fabric/energies.h"
#include "sim/fabric/vertex_solver.h"

#include <limits>

namespace sim {

/// Work of what acted from start_ to the state, by the forces at the state: backward Euler's are those at the end of a step.
EnergyChanges VertexSolver::energyChanges(double h, const Vec3& gravity, const FabricState& state)
{
    EnergyChanges changes;
    const std::size_t vertices = fabric_.vertexCount(), edges = fabric_.edges.size();
    const auto move = [&](std::size_t v) { return Vec3(state.x[v] - start_.x[v]); };
    const auto turn = [&](std::size_t e) { return state.theta[e] - start_.theta[e]; };
    const auto along = [&](const InnerGradient& gradient) {
        double sum = 0.0;
        for (std::size_t v = 0; v < vertices; ++v) sum += gradient.byPosition[v].dot(move(v));
        for (std::size_t e = 0; e < edges; ++e) sum += gradient.byAngle[e] * turn(e);
        return sum;
    };
    const auto gradientOver = [&](double length) {
        return innerGradient(fabric_, state, length, system_.unknowns(), system_.rods(), system_.shells());
    };
    InnerGradient gradient = gradientOver(h);  // of all that acts, in the end
    const double elastic = along(gradientOver(std::numeric_limits<double>::infinity()));
    changes[EnergyChange::Damping] = elastic - along(gradient);

    // Of stiff contact what the last iteration reckoned with: where that did not come quite there its force at the state is another.
    const auto solved = [&](int v) { return system_.move(v); };
    for (std::size_t i = 0; contacts_ && i < contacts_->size(); ++i) {
        const std::array<int, 4>& v = contacts_->vertices[i];
        const std::array<double, 4>& c = contacts_->weights[i];
        const Vec3& n = contacts_->normal[i];
        Vec3 apart = Vec3::Zero(), change = Vec3::Zero();
        for (int k = 0; k < 4; ++k) {
            apart += c[k] * move(v[k]);
            change += c[k] * solved(v[k]);
        }
        const double push = contacts_->force[i].dot(n) + contacts_->stiffness[i] * n.dot(change);
        const Vec3 all = contacts_->force[i] + contacts_->stiffness[i] * n.dot(change) * n + contacts_->frictionStiffness[i] * (change - n.dot(change) * n);
        changes[EnergyChange::Contact] -= push * n.dot(apart);
        changes[EnergyChange::Friction] -= (all - push * n).dot(apart);
        for (int k = 0; k < 4; ++k) gradient.byPosition[v[k]] += c[k] * all;
    }
    for (const ObstacleContact& contact : touching_) {
        const int a = contact.vertex, b = contact.isEdge() ? contact.other : a;
        const Vec3 force = contact.gradient + 0.5 * contact.stiffness * (solved(a) + solved(b));
        changes[EnergyChange::Obstacles] -= 0.5 * force.dot(move(a) + move(b));
        for (int v : {a, b}) gradient.byPosition[v] += 0.5 * force;
    }

    const double part = h / wholeStep_;
    for (std::size_t v = 0; v < vertices; ++v) {
        const Vec3 faster = state.v[v] - start_.v[v];
        Vec3 byLiquid = Vec3::Zero();
        if (loads_) byLiquid = part * (loads_->impulse[v] - loads_->drag[v].cwiseProduct(state.v[v]));
        changes[EnergyChange::Drag] += byLiquid.dot(state.v[v]);
        changes[EnergyChange::Implicit] -= 0.5 * mass_[v] * faster.squaredNorm();
        if (!fabric_.pinned[v]) continue;
        const Vec3 byPin = mass_[v] * (faster - h * gravity) - byLiquid + h * gradient.byPosition[v];
        changes[EnergyChange::Pins] += byPin.dot(state.v[v]);
    }
    for (std::size_t e = 0; e < edges; ++e) {
        const double inertia = fabric_.edges.twistInertia[e], faster = state.omega[e] - start_.omega[e];
        changes[EnergyChange::Implicit] -= 0.5 * inertia * faster * faster;
        if (fabric_.edges.twistHeld[e]) changes[EnergyChange::Pins] += (inertia * faster + h * gradient.byAngle[e]) * state.omega[e];
    }
    changes[EnergyChange::Implicit] += energies(state, gravity).elastic() - energies(start_, gravity).elastic() - elastic;
    return changes;
}

}  // namespace sim
