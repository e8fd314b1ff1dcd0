#include "sim/fabric/obstacle_contact.h"

#include "sim/core/parallel.h"

#include <cmath>

namespace sim {

namespace {

constexpr double kStiffness = 50.0;       ///< of the penalty relative to m/h² (contact-design 3.2) [-]
constexpr double kActivation = 0.25;      ///< distance at which it begins to act, in radii of the fabric [-]
constexpr double kSmoothingSpeed = 1.0;   ///< below which friction grows with the speed [cm/s]

/// f₁(u)/u of lagged smooth Coulomb friction, with u the slip in a step and e = h times the smoothing speed [1/cm].
double frictionPerSlip(double slip, double e) { return slip < e ? (2.0 - slip / e) / e : 1.0 / slip; }

}  // namespace

FabricObstacles::FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles)
{
    for (const ObstacleSettings& obstacle : obstacles) {
        if (!obstacle.collide) continue;
        Body& body = bodies_.emplace_back();
        body.pose.add(obstacle.shape, obstacle.motion);
        for (const FabricMaterial& material : fabric.materials) {
            const double own = std::tan(material.frictionAngle);
            body.friction.push_back(obstacle.frictionAngle ? std::sqrt(own * std::tan(*obstacle.frictionAngle)) : own);
        }
    }
}

void FabricObstacles::moveTo(double t0, double t1)
{
    for (Body& body : bodies_) body.pose.moveTo(t0, t1);
}

const std::vector<ObstacleContact>& FabricObstacles::at(const Fabric& fabric, std::span<const Vec3> x, std::span<const Vec3> start,
                                                        std::span<const Vec3> velocity, std::span<const double> mass, double h)
{
    const Chunks chunks(x.size());
    ofChunk_.resize(chunks.count());
    parallelFor(chunks.count(), [&](std::size_t c) {
        std::vector<ObstacleContact>& out = ofChunk_[c];
        out.clear();
        for (std::size_t v = chunks.begin(c); v < chunks.end(c); ++v) {
            if (fabric.pinned[v]) continue;
            const double activation = kActivation * fabric.radius[v];
            for (const Body& body : bodies_) {
                const double overlap = activation + fabric.radius[v] - body.pose.distance(x[v]);
                if (!(overlap > 0.0)) continue;
                const double stiffness = kStiffness * mass[v] / (h * h), push = stiffness * overlap;
                const Vec3 n = body.pose.normal(x[v]);
                ObstacleContact contact{static_cast<int>(v), -push * n, stiffness * n * n.transpose()};
                const auto along = [&](const Vec3& u) -> Vec3 { return u - u.dot(n) * n; };
                const Vec3 carriedBy = h * body.pose.velocity(x[v]), slip = along(x[v] - start[v] - carriedBy);
                double pressed = push, usualSlip = slip.norm();
                if (!velocity.empty()) {
                    pressed = stiffness * std::max(0.0, activation + fabric.radius[v] - body.pose.distance(start[v] + carriedBy));
                    usualSlip = along(h * velocity[v] - carriedBy).norm();
                }
                const double friction =
                    body.friction[fabric.vertexMaterial[v]] * pressed * frictionPerSlip(usualSlip, h * kSmoothingSpeed);
                contact.gradient += friction * slip;
                contact.stiffness += friction * (Mat3::Identity() - n * n.transpose());
                out.push_back(contact);
            }
        }
    });
    contacts_.clear();
    for (const std::vector<ObstacleContact>& part : ofChunk_) contacts_.insert(contacts_.end(), part.begin(), part.end());
    return contacts_;
}

double FabricObstacles::deepest(const Fabric& fabric, std::span<const Vec3> x) const
{
    double deepest = -std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_)
        for (std::size_t v = 0; v < x.size(); ++v) deepest = std::max(deepest, fabric.radius[v] - body.pose.distance(x[v]));
    return deepest;
}

}  // namespace sim
