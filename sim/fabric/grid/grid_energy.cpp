#include "sim/core/parallel.h"
#include "sim/fabric/grid/grid_solver.h"

namespace sim {

/// What the solve did with the fabric on the faces, and with its twist.
GridFabricSolver::OnFaces GridFabricSolver::workOnFaces(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads)
{
    const BlockGrid& grid = particles_.grid();
    const auto& sums = particles_.faces().sums;
    const BlockArray<double, 3>&first = particles_.velocity(), &last = velocity_.faces;
    OnFaces work;
    for (std::size_t e = 0; e < fabric_.edges.size(); ++e) {
        const double inertia = twistInertia(fabric_, state.absorbed, e), before = state.omega[e], after = velocity_.twist[e];
        work.kineticBefore += 0.5 * inertia * before * before;
        work.kineticAfter += 0.5 * inertia * after * after;
        work.ofChange += 0.5 * inertia * (after - before) * (after - before);
    }
    for (int b = 0; b < grid.count(); ++b) {
        const int loaded = loads ? loads->grid.find(grid.coords(b)) : BlockGrid::kNone;
        for (int a = 0; a < kAxes; ++a) {
            const double *mass = sums.block(b, FaceFields::kMass + a), *u0 = first.block(b, a), *u = last.block(b, a);
            for (int c = 0; c < kBlockCells; ++c) {
                if (!(mass[c] > 0.0)) continue;
                work.kineticBefore += 0.5 * mass[c] * u0[c] * u0[c];
                work.kineticAfter += 0.5 * mass[c] * u[c] * u[c];
                work.ofChange += 0.5 * mass[c] * (u[c] - u0[c]) * (u[c] - u0[c]);
                work.fall += h * mass[c] * gravity[a] * u[c];
                if (loaded == BlockGrid::kNone) continue;
                work.drag += (loads->impulse.block(loaded, a)[c] - loads->drag.block(loaded, a)[c] * u[c]) * u[c];
            }
        }
    }
    return work;
}

/// What the transfer to the faces and the solve there did; the state is still that of before. What is left to be booked when vertices have
/// moved is noted under Implicit and FabricToVertices.
void GridFabricSolver::bookSolve(double h, const Vec3& gravity, const FabricState& state, const FaceLoads* loads, EnergyChanges& changes)
{
    const FabricEnergies before = energies(state, gravity);
    const OnFaces onFaces = workOnFaces(h, gravity, state, loads);
    changes[EnergyChange::Drag] += onFaces.drag;
    changes[EnergyChange::Contact] = system_.contactWork(velocity_);
    const VertexStiffness::Work work = stiffness_.work(h, system_.vertexVelocities(velocity_));
    changes[EnergyChange::Damping] = work.damping;
    changes[EnergyChange::Obstacles] = work.obstacles;
    changes[EnergyChange::Pins] = work.pins;
    changes[EnergyChange::Implicit] += work.elastic - before.elastic() - onFaces.ofChange;
    changes[EnergyChange::FabricToGrid] = onFaces.kineticBefore - before.kinetic;
    changes[EnergyChange::FabricToVertices] = onFaces.fall - onFaces.kineticAfter - before.potential;
}

/// Books what was left of the step when the vertices have moved, after bookSolve.
void GridFabricSolver::bookVertices(const Vec3& gravity, const ContactEnergy& before, const FabricState& state, EnergyChanges& changes) const
{
    changes[EnergyChange::Contact] += state.stored.pressed - before.pressed;
    changes[EnergyChange::Obstacles] += state.stored.solids - before.solids;
    const FabricEnergies after = energies(state, gravity);
    changes[EnergyChange::Implicit] += after.elastic();
    changes[EnergyChange::FabricToVertices] += after.kinetic + after.potential;
}

}  // namespace sim
