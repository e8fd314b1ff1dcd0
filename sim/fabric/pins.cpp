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
    for (std::size_t i = 0; i < fabric.pins.vertex.size(); ++i)
        targets.push_back(pose[fabric.pins.motion[i]] * fabric.rest[fabric.pins.vertex[i]]);
    return targets;
}

double heldAngle(const Fabric& fabric, std::span<const Vec3> restReference, double t, const FabricState& state,
                 int edge)
{
    const std::optional<std::size_t> pin = pinOfEdge(fabric, edge);
    if (!pin) return state.theta[edge];
    const Motion& motion = fabric.pins.motions[fabric.pins.motion[*pin]];
    const Vec3 target = motion.transform(t).linear() * restReference[edge];
    const Vec3 &u = state.reference[edge], &tangent = state.tangent[edge];
    const double angle = std::atan2(tangent.dot(u.cross(target)), u.dot(target));
    return state.theta[edge] + std::remainder(angle - state.theta[edge], 2.0 * kPi);
}

std::optional<std::size_t> pinOfEdge(const Fabric& fabric, int edge)
{
    for (int v : fabric.edges.vertices[edge]) {
        const auto pin = std::ranges::lower_bound(fabric.pins.vertex, v);
        if (pin != fabric.pins.vertex.end() && *pin == v) return static_cast<std::size_t>(pin - fabric.pins.vertex.begin());
    }
    return std::nullopt;
}

}  // namespace sim
