#include "sim/fabric/pins.h"

#include "sim/core/units.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace sim {

std::vector<Vec3> pinTargets(const Fabric& fabric, double t)
{
    std::vector<Eigen::Isometry3d> pose;
    for (const Motion& motion : fabric.pins.motions) pose.push_back(motion.transform(t));
    std::vector<Vec3> targets;
    for (std::size_t i = 0; i < fabric.pins.vertex.size(); ++i) targets.push_back(pose[fabric.pins.motion[i]] * fabric.rest[fabric.pins.vertex[i]]);
    return targets;
}

double heldAngle(const Fabric& fabric, std::span<const Vec3> restReference, double t, const FabricState& state, int edge)
{
    const std::optional<std::size_t> pin = pinOfEdge(fabric, edge);
    if (!pin) return state.theta[edge];
    const Motion& motion = fabric.pins.motions[fabric.pins.motion[*pin]];
    const Vec3 target = motion.transform(t).linear() * restReference[edge];
    const Vec3 &u = state.reference[edge], &tangent = state.tangent[edge];
    const double angle = std::atan2(tangent.dot(u.cross(target)), u.dot(target));
    return state.theta[edge] + std::remainder(angle - state.theta[edge], 2.0 * kPi);
}

double pinTurn(const Fabric& fabric, std::span<const Vec3> restReference, double t0, double t1, const FabricState& state, int edge)
{
    const std::optional<std::size_t> pin = pinOfEdge(fabric, edge);
    const Motion* motion = pin ? &fabric.pins.motions[fabric.pins.motion[*pin]] : nullptr;
    if (!motion || !motion->moves(t0, t1)) return 0.0;
    const Vec3& tangent = state.tangent[edge];
    const auto across = [&](double t) -> Vec3 {
        const Vec3 first = motion->transform(t).linear() * restReference[edge];
        return first - first.dot(tangent) * tangent;
    };
    const Vec3 from = across(t0), to = across(t1);
    return std::atan2(tangent.dot(from.cross(to)), from.dot(to));
}

std::optional<std::size_t> pinOfEdge(const Fabric& fabric, int edge)
{
    for (int v : fabric.edges.vertices[edge]) {
        const auto pin = std::ranges::lower_bound(fabric.pins.vertex, v);
        if (pin != fabric.pins.vertex.end() && *pin == v) return static_cast<std::size_t>(pin - fabric.pins.vertex.begin());
    }
    return std::nullopt;
}

std::vector<int> nearestPins(const Fabric& fabric)
{
    std::vector<int> pin(fabric.vertexCount(), -1), reached = fabric.pins.vertex;
    for (int v : reached) pin[v] = v;
    std::vector<std::vector<int>> beside(reached.empty() ? 0 : fabric.vertexCount());
    const auto link = [&](int a, int b) {
        beside[a].push_back(b);
        beside[b].push_back(a);
    };
    if (reached.empty()) return pin;
    for (const Vec2i& e : fabric.edges.vertices) link(e[0], e[1]);
    for (const Vec3i& f : fabric.faces.vertices)
        for (int k = 0; k < 3; ++k) link(f[k], f[(k + 1) % 3]);
    for (std::size_t n = 0; n < reached.size(); ++n)
        for (int v : beside[reached[n]])
            if (pin[v] < 0) {
                pin[v] = pin[reached[n]];
                reached.push_back(v);
            }
    return pin;
}

}  // namespace sim
