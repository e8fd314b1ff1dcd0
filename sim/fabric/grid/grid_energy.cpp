#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"

namespace sim {

/// Kinetic energy of velocities on the faces; liquid's drag is no mass here [erg].
double GridFabricSolver::facesKinetic(const BlockArray<double, 3>& velocity) const
{
    const auto& sums = particles_.faces().sums;
    double energy = 0.0;
    for (int b = 0; b < particles_.grid().count(); ++b)
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = sums.block(b, FaceFields::kMass + a), *u = velocity.block(b, a);
            for (int c = 0; c < kBlockCells; ++c)
                if (mass[c] > 0.0) energy += 0.5 * mass[c] * u[c] * u[c];
        }
    return energy;
}

/// What the transfer to the faces and the solve there did; the state is still that of before. What is left to be booked when vertices have
/// moved is noted under Implicit and FabricToVertices.
void GridFabricSolver::bookSolve(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads, EnergyChanges& changes)
{
    const FabricEnergies before = energies(state, gravity);
    const BlockGrid& grid = particles_.grid();
    const auto& sums = particles_.faces().sums;
    const BlockArray<double, 3>&first = particles_.velocity(), &last = velocity_.faces;
    double twistKinetic = 0.0, twistStart = 0.0, fall = 0.0;
    for (std::size_t e = 0; e < fabric_.edges.size(); ++e) {
        const double inertia = twistInertia(fabric_, state.absorbed, e), faster = velocity_.twist[e] - state.omega[e];
        twistStart += 0.5 * inertia * state.omega[e] * state.omega[e];
        twistKinetic += 0.5 * inertia * velocity_.twist[e] * velocity_.twist[e];
        changes[EnergyChange::Implicit] -= 0.5 * inertia * faster * faster;
    }
    for (int b = 0; b < grid.count(); ++b) {
        const int loaded = loads ? loads->grid.find(grid.coords(b)) : BlockGrid::kNone;
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = sums.block(b, FaceFields::kMass + a), *u0 = first.block(b, a), *u = last.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) {
                if (!(mass[c] > 0.0)) continue;
                changes[EnergyChange::Implicit] -= 0.5 * mass[c] * (u[c] - u0[c]) * (u[c] - u0[c]);
                fall += h * mass[c] * gravity[a] * u[c];
                if (loaded == BlockGrid::kNone) continue;
                changes[EnergyChange::Drag] += (loads->impulse.block(loaded, a)[c] - loads->drag.block(loaded, a)[c] * u[c]) * u[c];
            }
        }
    }
    const double kinetic = facesKinetic(last) + twistKinetic;
    changes[EnergyChange::Contact] = system_.contactWork(velocity_);
    const VertexStiffness::Work work = stiffness_.work(h, system_.onVertices(velocity_));
    changes[EnergyChange::Damping] = work.damping;
    changes[EnergyChange::Obstacles] = work.obstacles;
    changes[EnergyChange::Pins] = work.pins;
    changes[EnergyChange::Implicit] += work.elastic - before.elastic();
    changes[EnergyChange::FabricToGrid] = facesKinetic(first) + twistStart - before.kinetic;
    changes[EnergyChange::FabricToVertices] = fall - kinetic - before.potential;
}

/// The rest, when the vertices have moved.
void GridFabricSolver::bookVertices(const Vec3& gravity, const ContactEnergy& before, const FabricState& state, EnergyChanges& changes) const
{
    changes[EnergyChange::Contact] += state.stored.pressed - before.pressed;
    changes[EnergyChange::Obstacles] += state.stored.solids - before.solids;
    const FabricEnergies after = energies(state, gravity);
    changes[EnergyChange::Implicit] += after.elastic();
    changes[EnergyChange::FabricToVertices] += after.kinetic + after.potential;
}

}  // namespace sim
