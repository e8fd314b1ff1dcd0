#include "sim/fabric/obstacle_contact.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    if (!bodies_.empty()) findEdges(fabric);
}

void FabricObstacles::findEdges(const Fabric& fabric)
{
    edges_ = fabric.edges.vertices;
    for (const Vec3i& f : fabric.faces.vertices)
        for (int k = 0; k < 3; ++k) edges_.emplace_back(f[k], f[(k + 1) % 3]);
    for (Vec2i& e : edges_) e = {e.minCoeff(), e.maxCoeff()};
    const auto before = [](const Vec2i& a, const Vec2i& b) { return std::pair(a[0], a[1]) < std::pair(b[0], b[1]); };
    std::ranges::sort(edges_, before);
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    share_.assign(fabric.vertexCount(), 0.0);
    for (const Vec2i& e : edges_)
        for (int v : e) share_[v] += 1.0;
    for (double& share : share_) share = share > 0.0 ? 1.0 / share : 0.0;
    nearest_.resize(fabric.vertexCount());
}

void FabricObstacles::moveTo(double t0, double t1)
{
    for (Body& body : bodies_) body.pose.moveTo(t0, t1);
}

/// give(gradient [dyn], stiffness [dyn/cm]) of the contacts of a point.
void FabricObstacles::touch(const Point& point, double h, auto&& give) const
{
    for (const Body& body : bodies_) {
        const double overlap = point.reach - body.pose.distance(point.x);
        if (!(overlap > 0.0)) continue;
        const double stiffness = kStiffness * point.mass / (h * h), push = stiffness * overlap;
        const Vec3 n = body.pose.normal(point.x);
        const auto along = [&](const Vec3& u) -> Vec3 { return u - u.dot(n) * n; };
        const Vec3 carriedBy = h * body.pose.velocity(point.x), slip = along(point.x - point.start - carriedBy);
        double pressed = push, usualSlip = slip.norm();
        if (point.velocity) {
            pressed = stiffness * std::max(0.0, point.reach - body.pose.distance(point.start + carriedBy));
            usualSlip = along(h * *point.velocity - carriedBy).norm();
        }
        const double friction = body.friction[point.material] * pressed * frictionPerSlip(usualSlip, h * kSmoothingSpeed);
        const Mat3 across = n * n.transpose();
        give(friction * slip - push * n, stiffness * across + friction * (Mat3::Identity() - across));
    }
}

const std::vector<ObstacleContact>& FabricObstacles::at(const Fabric& fabric, std::span<const Vec3> x, std::span<const Vec3> start,
                                                        std::span<const Vec3> velocity, std::span<const double> mass, double h,
                                                        std::span<const NearestPoint> nearest)
{
    contacts_.clear();
    const auto collect = [&](std::size_t n, auto&& body) {
        const Chunks chunks(n);
        ofChunk_.resize(std::max(ofChunk_.size(), chunks.count()));
        parallelFor(chunks.count(), [&](std::size_t c) {
            ofChunk_[c].clear();
            for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i) body(i, ofChunk_[c]);
        });
        for (std::size_t c = 0; c < chunks.count(); ++c) contacts_.insert(contacts_.end(), ofChunk_[c].begin(), ofChunk_[c].end());
    };
    collect(x.size(), [&](std::size_t v, std::vector<ObstacleContact>& out) {
        nearest_[v] = std::numeric_limits<double>::infinity();
        for (const Body& body : bodies_) nearest_[v] = std::min(nearest_[v], body.pose.distance(x[v]));
        const double reach = (1.0 + kActivation) * fabric.radius[v];
        if (fabric.pinned[v] || nearest_[v] >= reach) return;
        const Point point{x[v], start[v], reach, mass[v], fabric.vertexMaterial[v], velocity.empty() ? nullptr : &velocity[v]};
        touch(point, h, [&](const Vec3& gradient, const Mat3& stiffness) { out.push_back({static_cast<int>(v), ObstacleContact::kNone, gradient, stiffness}); });
    });
    collect(edges_.size(), [&](std::size_t i, std::vector<ObstacleContact>& out) {
        const int a = edges_[i][0], b = edges_[i][1];
        // Where an obstacle is flat the ends, which begin to feel it earlier, keep it away from the middle.
        const double reach = 0.5 * (fabric.radius[a] + fabric.radius[b]);
        if (std::max(nearest_[a], nearest_[b]) - 0.5 * (x[b] - x[a]).norm() >= reach) return;
        const Vec3 middle = velocity.empty() ? Vec3::Zero().eval() : Vec3(0.5 * (velocity[a] + velocity[b]));
        const Point point{0.5 * (x[a] + x[b]),         0.5 * (start[a] + start[b]),        reach, share_[a] * mass[a] + share_[b] * mass[b],
                          fabric.vertexMaterial[a], velocity.empty() ? nullptr : &middle};
        touch(point, h, [&](const Vec3& gradient, const Mat3& stiffness) {
            out.push_back({a, b, gradient, stiffness});
        });
    });
    collect(nearest.size(), [&](std::size_t i, std::vector<ObstacleContact>& out) {
        const NearestPoint& p = nearest[i];
        const auto mean = [&](std::span<const Vec3> values) -> Vec3 {
            Vec3 sum = Vec3::Zero();
            for (int c = 0; c < p.corners; ++c) sum += p.weights[c] * values[p.vertices[c]];
            return sum;
        };
        double compliance = 0.0;
        for (int c = 0; c < p.corners; ++c) compliance += p.weights[c] * p.weights[c] / mass[p.vertices[c]];
        const Vec3 ownVelocity = velocity.empty() ? Vec3::Zero().eval() : mean(velocity);
        const Point point{mean(x), mean(start), p.radius, 1.0 / compliance, fabric.vertexMaterial[p.vertices[0]], velocity.empty() ? nullptr : &ownVelocity};
        touch(point, h, [&](const Vec3& gradient, const Mat3& stiffness) {
            out.push_back({p.vertices[0], p.vertices[1], gradient, stiffness, p.corners == 3 ? p.vertices[2] : ObstacleContact::kNone, p.weights});
        });
    });
    return contacts_;
}

double FabricObstacles::deepest(const Fabric& fabric, std::span<const Vec3> x) const
{
    const auto reach = [&](const Vec3& at, double radius) {
        double deepest = -std::numeric_limits<double>::infinity();
        for (const Body& body : bodies_) deepest = std::max(deepest, radius - body.pose.distance(at));
        return deepest;
    };
    const double ofVertices = parallelMax(x.size(), [&](std::size_t v) { return reach(x[v], fabric.radius[v]); });
    const double ofEdges = parallelMax(edges_.size(), [&](std::size_t i) {
        const auto [a, b] = std::pair(edges_[i][0], edges_[i][1]);
        return reach(0.5 * (x[a] + x[b]), 0.5 * (fabric.radius[a] + fabric.radius[b]));
    });
    return std::max(ofVertices, ofEdges);
}

}  // namespace sim
