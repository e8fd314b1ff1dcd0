#include "sim/fabric/energies.h"

#include "sim/core/parallel.h"

namespace sim {

FabricEnergies elasticEnergies(const FabricState& state, const Rods& rods, const Shells& shells)
{
    FabricEnergies e;
    const auto [stretching, bending, twisting] = rods.energies(state);
    const auto [membrane, shellBending] = shells.energies(state.x);
    e.stretching = stretching, e.bending = bending, e.twisting = twisting;
    e.membrane = membrane, e.shellBending = shellBending;
    return e;
}

const FabricEnergies& ElasticEnergies::at(const FabricState& state, const Rods& rods, const Shells& shells)
{
    if (state.x != x_ || state.theta != theta_ || state.reference != reference_ || state.referenceTwist != referenceTwist_) {
        x_ = state.x, theta_ = state.theta, reference_ = state.reference, referenceTwist_ = state.referenceTwist;
        energies_ = elasticEnergies(state, rods, shells);
    }
    return energies_;
}

FabricEnergies fabricEnergies(const Fabric& fabric, const FabricState& state, const FabricEnergies& elastic, const Vec3& gravity)
{
    FabricEnergies e = elastic;
    const auto mass = [&](std::size_t v) { return fabric.mass[v] + state.absorbed[v]; };
    e.kinetic = parallelSum(fabric.vertexCount(), [&](std::size_t v) { return 0.5 * mass(v) * state.v[v].squaredNorm(); });
    e.kinetic += parallelSum(fabric.edges.size(),
                             [&](std::size_t n) { return 0.5 * twistInertia(fabric, state.absorbed, n) * state.omega[n] * state.omega[n]; });
    e.potential = -parallelSum(fabric.vertexCount(), [&](std::size_t v) { return mass(v) * gravity.dot(state.x[v]); });
    e.contact = state.stored.sum();
    return e;
}

InternalGradient internalGradient(const Fabric& fabric, const FabricState& state, double h, const VertexUnknowns& unknowns, const ElasticStep& step)
{
    const Rods& rods = step.rods.rods();
    const Shells& shells = step.shells.shells();
    AlignedArray<double> all;
    all.resize(unknowns.size);
    all.fill(0.0);
    if (!rods.empty()) step.rods.forces(state, h, packsOf(all), nullptr);
    if (!shells.empty()) step.shells.forces(state.x, h, unknowns.slot, all, nullptr);

    InternalGradient gradient{std::vector<Vec3>(fabric.vertexCount(), Vec3::Zero()), std::vector<double>(fabric.edges.size())};
    const auto add = [&](int v, int slot) { gradient.byPosition[v] += Vec3(all[slot], all[slot + kLanes], all[slot + 2 * kLanes]); };
    const StrandLayout& layout = rods.layout();
    for (const StrandLayout::Group& group : layout.groups)  // a vertex on several strands has a part in each
        for (int j = 0; j < group.vertices; ++j)
            for (int l = 0; l < kLanes; ++l)
                if (const int v = layout.vertex[group.firstVertex + j][l]; v >= 0) add(v, (group.firstRow + 4 * j) * kLanes + l);
    for (int v : shells.vertices())
        if (!unknowns.isOnStrand(v)) add(v, unknowns.slot[v]);
    for (std::size_t e = 0; e < fabric.edges.size(); ++e) gradient.byAngle[e] = all[unknowns.twistSlot[e]];
    return gradient;
}

}  // namespace sim
