#include "sim/fabric/energies.h"

#include "sim/core/parallel.h"

namespace sim {

FabricEnergies fabricEnergies(const Fabric& fabric, const FabricState& state, const Rods& rods, const Shells& shells,
                              const Vec3& gravity)
{
    FabricEnergies e;
    const auto mass = [&](std::size_t v) { return fabric.mass[v] + state.absorbed[v]; };
    e.kinetic = parallelSum(fabric.vertexCount(), [&](std::size_t v) { return 0.5 * mass(v) * state.v[v].squaredNorm(); });
    e.kinetic += parallelSum(fabric.edges.size(), [&](std::size_t n) {
        return 0.5 * fabric.edges.twistInertia[n] * state.omega[n] * state.omega[n];
    });
    e.potential = -parallelSum(fabric.vertexCount(), [&](std::size_t v) { return mass(v) * gravity.dot(state.x[v]); });
    const auto [stretching, bending, twisting] = rods.energies(state);
    const auto [membrane, shellBending] = shells.energies(state.x);
    e.stretching = stretching, e.bending = bending, e.twisting = twisting;
    e.membrane = membrane, e.shellBending = shellBending;
    return e;
}

}  // namespace sim
