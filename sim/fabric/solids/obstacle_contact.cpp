#include "sim/fabric/solids/obstacle_contact.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

constexpr double kStiffness = 50.0;   ///< stiffness of the penalty relative to m/h² (fabric/README.md, Solids) [-]
constexpr double kActivation = 0.25;  ///< distance at which it begins to act, in radii of the fabric [-]

}  // namespace

FabricObstacles::FabricObstacles(const Fabric& fabric, std::span<const ObstacleSettings> obstacles, const Cohesion* cohesion) : cohesion_(cohesion)
{
    for (std::size_t n = 0; n < obstacles.size(); ++n) {
        const ObstacleSettings& obstacle = obstacles[n];
        if (!obstacle.collide || obstacle.shape.empty()) continue;  // as SolidLimiter counts them
        Body& body = bodies_.emplace_back();
        body.inScene = static_cast<int>(n);
        body.pose.add(obstacle.shape, obstacle.motion);
        body.motion = obstacle.motion;
        body.isCohesive = obstacle.cohesive;
        for (const FabricMaterial& material : fabric.materials) {
            const double own = std::tan(material.frictionAngle);
            body.friction.push_back(obstacle.frictionAngle ? std::sqrt(own * std::tan(*obstacle.frictionAngle)) : own);
        }
    }
    if (!bodies_.empty()) findEdges(fabric);
}

int FabricObstacles::nearest(const Vec3& x) const
{
    const auto distance = [&](const Body& body) { return body.pose.distance(x); };
    return static_cast<int>(std::ranges::min_element(bodies_, {}, distance) - bodies_.begin());
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
    pushedOut_.resize(fabric.vertexCount());
}

void FabricObstacles::moveTo(double t0, double t1)
{
    for (Body& body : bodies_) {
        body.pose.moveTo(t0, t1);
        body.carry = Eigen::Isometry3d::Identity();
        if (body.motion.moves(t0, t1)) body.carry = body.motion.transform(t1) * body.motion.transform(t0).inverse();
    }
}

FabricObstacles::Point FabricObstacles::vertexPoint(const Fabric& fabric, int v, std::span<const Vec3> x, const Start& start) const
{
    const Vec3 move = start.moves.empty() ? Vec3::Zero().eval() : start.moves[v];
    Point point{v, x[v], start.x[v], (1.0 + kActivation) * fabric.radius[v], start.mass[v], fabric.vertexMaterial[v], move};
    if (cohesion_ && cohesion_->isOnObstacles()) {
        point.pull = cohesion_->onObstacle(v);
        point.bridge = kBridgeLength * fabric.radius[v];
    }
    return point;
}

/// Where an obstacle is flat the ends, which begin to feel it earlier, keep it away from the middle.
FabricObstacles::Point FabricObstacles::edgePoint(const Fabric& fabric, int edge, std::span<const Vec3> x, const Start& start) const
{
    const int a = edges_[edge][0], b = edges_[edge][1];
    const auto middle = [&](std::span<const Vec3> of) -> Vec3 { return 0.5 * (of[a] + of[b]); };
    const Vec3 move = start.moves.empty() ? Vec3::Zero().eval() : middle(start.moves);
    return {static_cast<int>(share_.size()) + edge,
            middle(x),
            middle(start.x),
            0.5 * (fabric.radius[a] + fabric.radius[b]),
            share_[a] * start.mass[a] + share_[b] * start.mass[b],
            fabric.vertexMaterial[a],
            move};
}

/// A nearest point as one that may touch, as heavy as its corners make it.
FabricObstacles::Point FabricObstacles::nearestPoint(const Fabric& fabric, const NearestPoint& p, std::span<const Vec3> x, const Start& start) const
{
    const auto mean = [&](std::span<const Vec3> of) -> Vec3 {
        Vec3 sum = Vec3::Zero();
        for (int c = 0; c < p.corners; ++c) sum += p.weights[c] * of[p.vertices[c]];
        return sum;
    };
    double compliance = 0.0;
    for (int c = 0; c < p.corners; ++c) compliance += p.weights[c] * p.weights[c] / start.mass[p.vertices[c]];
    const Vec3 move = start.moves.empty() ? Vec3::Zero().eval() : mean(start.moves);
    const int number = static_cast<int>(share_.size() + edges_.size()) + p.element;
    return {number, mean(x), mean(start.x), p.radius, 1.0 / compliance, fabric.vertexMaterial[p.vertices[0]], move};
}

/// Stiffness of the penalty on a point [dyn/cm].
double FabricObstacles::stiffnessOf(const Point& point, const Start& start)
{
    return kStiffness * point.mass / (start.springStep * start.springStep);
}

/// Force of the bridge between a point and an obstacle [dyn]. It comes about between steps, so that Newton's iterations do not make and break it.
double FabricObstacles::bridgeForceOf(const Point& point, int obstacle) const
{
    const Body& body = bodies_[obstacle];
    if (!body.isCohesive || !(point.pull > 0.0)) return 0.0;
    return body.pose.distance(body.carry * point.start) < point.reach + point.bridge ? point.pull : 0.0;
}

std::optional<FabricObstacles::Touch> FabricObstacles::touch(const Point& point, int obstacle, const Start& start) const
{
    const Body& body = bodies_[obstacle];
    const double overlap = point.reach - body.pose.distance(point.x);
    const double pull = overlap > -point.bridge ? bridgeForceOf(point, obstacle) : 0.0;
    if (!(overlap > 0.0 || pull > 0.0)) return std::nullopt;
    const Vec3 n = body.pose.normal(point.x);
    if (!(overlap > 0.0)) return Touch{n, 0.0, pull, 0.0, 0.0, {Vec3::Zero()}};
    const double stiffness = stiffnessOf(point, start), push = stiffness * overlap;
    const auto along = [&](const Vec3& u) -> Vec3 { return u - u.dot(n) * n; };
    const Vec3 carried = body.carry * point.start, slip = along(point.x - carried);
    const Vec3 held = along(body.carry.linear() * start.held.at({point.number, obstacle}));
    const double coefficient = body.friction[point.material];
    if (start.moves.empty()) return Touch{n, overlap, pull, push, stiffness, FrictionSpring{held, stiffness, coefficient * push}.at(slip)};
    const double pressed = stiffness * std::max(0.0, point.reach - body.pose.distance(carried));
    const FrictionSpring spring{held, stiffness, coefficient * pressed};
    return Touch{n,    overlap,   pull,
                 push, stiffness, spring.expected(slip, along(point.start + point.move - carried), stiffness * start.h * start.h / point.mass)};
}

FabricObstacles::Point FabricObstacles::pointOf(const Fabric& fabric, const ObstacleContact& contact, std::span<const Vec3> x,
                                                const Start& start) const
{
    const int vertices = static_cast<int>(share_.size()), nearest = vertices + static_cast<int>(edges_.size()), number = contact.between[0];
    if (number < vertices) return vertexPoint(fabric, number, x, start);
    if (number < nearest) return edgePoint(fabric, number - vertices, x, start);
    NearestPoint p{number - nearest, contact.between[1], contact.third == ObstacleContact::kNone ? 2 : 3, contact.vertices(), contact.weights, 0.0};
    p.radius = fabric.radius[p.vertices[0]];
    for (int v : p.vertices) p.radius = std::min(p.radius, fabric.radius[v]);
    return nearestPoint(fabric, p, x, start);
}

/// The contact of a point between these corners with an obstacle, if they touch; how far it pushes the point [cm].
Vec3 FabricObstacles::collect(const Point& point, int obstacle, const ObstacleContact& corners, const Start& start,
                              std::vector<ObstacleContact>& out) const
{
    const std::optional<Touch> touching = touch(point, obstacle, start);
    if (!touching) return Vec3::Zero();
    const Vec3& n = touching->normal;
    ObstacleContact& contact = out.emplace_back(corners);
    contact.between = {point.number, obstacle};
    contact.pull = touching->pull;
    contact.gradient = touching->friction.force + (touching->pull - touching->push) * n;
    contact.stiffness = touching->stiffness * n * n.transpose() + touching->friction.matrix(n);
    contact.place = point.x;
    return touching->overlap * n;
}

/// The contacts of a point between these corners with all obstacles; how far they push the point [cm].
Vec3 FabricObstacles::collect(const Point& point, const ObstacleContact& corners, const Start& start, std::vector<ObstacleContact>& out) const
{
    Vec3 pushedOut = Vec3::Zero();
    for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) pushedOut += collect(point, body, corners, start, out);
    return pushedOut;
}

bool FabricObstacles::touches(const Vec3& x, double reach) const
{
    return std::ranges::any_of(bodies_, [&](const Body& body) { return body.pose.distance(x) < reach; });
}

FabricObstacles::Found FabricObstacles::findContacts(const Fabric& fabric, std::span<const Vec3> x, const Start& start,
                                                     std::span<const NearestPoint> nearest)
{
    contacts_.clear();
    const auto collectFrom = [&](std::size_t n, auto&& body) {
        const Chunks chunks(n);
        ofChunk_.resize(std::max(ofChunk_.size(), chunks.count()));
        parallelFor(chunks.count(), [&](std::size_t c) {
            ofChunk_[c].clear();
            for (std::size_t i = chunks.begin(c); i < chunks.end(c); ++i) body(i, ofChunk_[c]);
        });
        for (std::size_t c = 0; c < chunks.count(); ++c) contacts_.insert(contacts_.end(), ofChunk_[c].begin(), ofChunk_[c].end());
    };
    collectFrom(x.size(), [&](std::size_t v, std::vector<ObstacleContact>& out) {
        nearest_[v] = std::numeric_limits<double>::infinity();
        for (const Body& body : bodies_) nearest_[v] = std::min(nearest_[v], body.pose.distance(x[v]));
        const Point point = vertexPoint(fabric, static_cast<int>(v), x, start);
        pushedOut_[v].setZero();
        if (!fabric.pinned[v] && nearest_[v] < point.reach + point.bridge) pushedOut_[v] = collect(point, {static_cast<int>(v)}, start, out);
    });
    collectFrom(edges_.size(), [&](std::size_t i, std::vector<ObstacleContact>& out) {
        const int a = edges_[i][0], b = edges_[i][1];
        const Point point = edgePoint(fabric, static_cast<int>(i), x, start);
        if (std::max(nearest_[a], nearest_[b]) - 0.5 * (x[b] - x[a]).norm() >= point.reach) return;
        // A middle that its ends will lift off is left to them: a spring of its own would pull it back.
        const Vec3 lifted = point.x + 0.5 * (pushedOut_[a] + pushedOut_[b]);
        if (touches(lifted, point.reach)) collect(point, {a, b}, start, out);
    });
    collectFrom(nearest.size(), [&](std::size_t i, std::vector<ObstacleContact>& out) {
        const NearestPoint& p = nearest[i];
        ObstacleContact corners{p.vertices[0], p.vertices[1]};
        corners.third = p.corners == 3 ? p.vertices[2] : ObstacleContact::kNone;
        corners.weights = p.weights;
        collect(nearestPoint(fabric, p, x, start), p.body, corners, start, out);
    });
    return Found(*this, fabric);
}

void FabricObstacles::Found::storeFriction(std::span<const Vec3> x, const Start& start, FrictionForces& held, std::span<Vec3> acceleration) const
{
    std::vector<std::optional<Vec3>>& force = in_->keptForce_;
    force.resize(in_->contacts_.size());
    in_->lostForce_.resize(in_->contacts_.size());
    parallelFor(in_->contacts_.size(), 256, [&](std::size_t i) {
        force[i].reset();
        const ObstacleContact& c = in_->contacts_[i];
        const Point point = in_->pointOf(*fabric_, c, x, start);
        const Body& body = in_->bodies_[c.between[1]];
        const double overlap = point.reach - body.pose.distance(point.x);
        const Vec3 n = body.pose.normal(point.x), all = c.gradient + c.stiffness * (point.x - c.place), acted = all - all.dot(n) * n;
        in_->lostForce_[i] = acted;
        if (!(overlap > 0.0)) return;
        const double bound = body.friction[point.material] * stiffnessOf(point, start) * overlap;
        force[i] = atMost(bound, acted);
        in_->lostForce_[i] -= *force[i];
    });
    held.clear();
    for (std::size_t i = 0; i < in_->contacts_.size(); ++i)
        if (force[i]) held.add(in_->contacts_[i].between, *force[i]);
    if (acceleration.empty()) return;
    for (std::size_t i = 0; i < in_->contacts_.size(); ++i) {
        const std::array<int, 3> v = in_->contacts_[i].vertices();
        const std::array<double, 3> share = in_->contacts_[i].shares();
        for (int k = 0; k < 3; ++k) acceleration[v[k]] += share[k] / start.mass[v[k]] * in_->lostForce_[i];
    }
}

double FabricObstacles::Found::storedEnergy(std::span<const Vec3> x, const Start& start, const FrictionForces& held) const
{
    return parallelSum(in_->contacts_.size(),
                       [&](std::size_t i) {
                           const ObstacleContact& c = in_->contacts_[i];
                           const Point point = in_->pointOf(*fabric_, c, x, start);
                           const double overlap = std::max(0.0, point.reach - in_->bodies_[c.between[1]].pose.distance(point.x)),
                                        stiffness = stiffnessOf(point, start);
                           return 0.5 * stiffness * overlap * overlap + 0.5 * held.at(c.between).squaredNorm() / stiffness;
                       }) +
           bridgeEnergy(x);
}

double FabricObstacles::Found::bridgeEnergy(std::span<const Vec3> x) const
{
    if (!in_->cohesion_ || !in_->cohesion_->isOnObstacles()) return 0.0;
    return -parallelSum(in_->contacts_.size(), [&](std::size_t i) {
        const ObstacleContact& c = in_->contacts_[i];
        if (!(c.pull > 0.0)) return 0.0;
        const double longest = (1.0 + kActivation + kBridgeLength) * fabric_->radius[c.vertex];
        return c.pull * std::max(0.0, longest - in_->bodies_[c.between[1]].pose.distance(x[c.vertex]));
    });
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
