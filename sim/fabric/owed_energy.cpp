#include "sim/fabric/owed_energy.h"

#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace sim {

namespace {

constexpr double kStretched = 1.1;  ///< stretch from which on it is worth telling [-]
constexpr double kMostOwed = 0.01;  ///< debt with which a run may go on, relative to the largest kinetic energy: what its energies are held to [-]

}  // namespace

double externalWork(const EnergyChanges& changes)
{
    return changes[EnergyChange::Pins] + changes[EnergyChange::Obstacles] + changes[EnergyChange::Drag];
}

double ownKinetic(const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, const FabricState& state)
{
    const std::vector<Vec3> drift = groups.drifts(mass, state.v);
    double kinetic = 0.0;
    for (std::size_t v = 0; v < state.v.size(); ++v)
        if (!fabric.pinned[v]) kinetic += 0.5 * mass[v] * (state.v[v] - drift[groups.pieceOf(static_cast<int>(v))]).squaredNorm();
    for (std::size_t e = 0; e < state.omega.size(); ++e)
        if (!fabric.edges.twistHeld[e]) kinetic += 0.5 * twistInertia(fabric, state.absorbed, e) * state.omega[e] * state.omega[e];
    return kinetic;
}

double slowDown(double energy, const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, FabricState& state)
{
    if (!(energy > 0.0)) return 0.0;
    const double kinetic = ownKinetic(fabric, groups, mass, state);
    if (!(kinetic > 0.0)) return 0.0;
    const std::vector<Vec3> drift = groups.drifts(mass, state.v);
    const double lost = 1.0 - std::sqrt(std::max(0.0, 1.0 - energy / kinetic));
    for (std::size_t v = 0; v < state.v.size(); ++v)
        if (!fabric.pinned[v]) state.v[v] -= lost * (state.v[v] - drift[groups.pieceOf(static_cast<int>(v))]);
    for (std::size_t e = 0; e < state.omega.size(); ++e)
        if (!fabric.edges.twistHeld[e]) state.omega[e] *= 1.0 - lost;
    return std::min(energy, kinetic);
}

double payOwed(double due, const Fabric& fabric, const FabricGroups& groups, std::span<const double> mass, FabricState& state)
{
    const double paid = slowDown(due, fabric, groups, mass, state);
    state.vertexSolver.owed = std::max(0.0, due - paid);
    return paid;
}

void throwJammed(const Fabric& fabric, const FabricState& state, double kinetic)
{
    if (state.vertexSolver.owed <= std::max(kinetic, kMostOwed * state.mostKinetic)) return;
    Vec3 place = state.x[0];
    double longest = 0.0;
    const auto look = [&](int a, int b) {
        const double stretched = (state.x[a] - state.x[b]).norm() / (fabric.rest[a] - fabric.rest[b]).norm();
        if (stretched > longest) longest = stretched, place = 0.5 * (state.x[a] + state.x[b]);
    };
    for (const Vec2i& e : fabric.edges.vertices) look(e[0], e[1]);
    for (const Vec3i& f : fabric.faces.vertices)
        for (int k = 0; k < 3; ++k) look(f[k], f[(k + 1) % 3]);
    const std::string stretched = longest < kStretched ? ""
                                                       : fmt::format("; near ({:.4g}, {:.4g}, {:.4g}) cm it is stretched to {:.3g} times its length",
                                                                     place.x(), place.y(), place.z(), longest);
    throw RunError(fmt::format(
        "fabric is jammed: pins or solids lead it where it cannot follow in steps of this length, and it has come to hold {:.3g} erg that "
        "nothing gave to it{}; other or slower motions, more room or shorter steps would do",
        state.vertexSolver.owed, stretched));
}

}  // namespace sim
