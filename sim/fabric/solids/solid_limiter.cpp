#include "sim/fabric/solids/solid_limiter.h"

#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sim {

using namespace solids;

namespace {

constexpr double kPushed = 4.0;     ///< distance within which a solid may push [radii]
constexpr double kInterior = 0.95;  ///< weight of a corner from which on the corner itself is what touches [-]

/// Around all ways; without moves, around all places.
Eigen::AlignedBox3d boxAround(std::span<const Vec3> x, std::span<const Vec3> u)
{
    const Eigen::AlignedBox3d nothing;
    return parallelReduce(
        x.size(), nothing, [&](std::size_t v) { return u.empty() ? Eigen::AlignedBox3d(x[v]) : Eigen::AlignedBox3d(x[v]).extend(x[v] + u[v]); },
        [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged(b); });
}

}  // namespace

SolidLimiter::SolidLimiter(const Fabric& fabric, std::span<const ObstacleSettings> obstacles) : fabric_(&fabric)
{
    for (const ObstacleSettings& obstacle : obstacles) {
        if (!obstacle.collide || obstacle.shape.empty()) continue;
        Body& body = bodies_.emplace_back();
        body.name = obstacle.name;
        body.shape = obstacle.shape;
        body.motion = obstacle.motion;
        body.steepest = obstacle.shape.steepest();
        body.distance.resize(fabric.vertexCount());
        body.clear.resize(fabric.vertexCount());
    }
    if (bodies_.empty()) return;
    for (const Vec2i& e : fabric.edges.vertices) elements_.push_back({e[0], e[1], -1});
    for (const Vec3i& f : fabric.faces.vertices) {
        elements_.push_back({f[0], f[1], f[2]});
        for (int k = 0; k < 3; ++k) clothEdges_.push_back({std::min(f[k], f[(k + 1) % 3]), std::max(f[k], f[(k + 1) % 3]), -1});
    }
    std::ranges::sort(clothEdges_);
    clothEdges_.erase(std::unique(clothEdges_.begin(), clothEdges_.end()), clothEdges_.end());
    slid_.resize(fabric.vertexCount());
    isLeft_.resize(elements_.size());
    moveTo(0.0, 0.0);
}

void SolidLimiter::moveTo(double t0, double t1)
{
    std::ranges::fill(isLeft_, 0);
    for (Body& body : bodies_) {
        body.moves = body.motion.moves(t0, t1);
        body.end = body.motion.transform(t1);
        body.toEnd = body.end.inverse();
        body.toBegin = body.moves ? body.motion.transform(t0).inverse() : body.toEnd;
    }
}

void SolidLimiter::rest()
{
    for (Body& body : bodies_) {
        body.moves = false;
        body.toBegin = body.toEnd;
    }
}

/// Does one of the solids found near move?
bool SolidLimiter::anyMovesNear() const
{
    return std::ranges::any_of(bodies_, [](const Body& body) { return body.isNear && body.moves; });
}

bool SolidLimiter::movesNear(Points x, std::span<const Vec3> u)
{
    if (bodies_.empty()) return false;
    findNear(x, u, kPushed);
    return anyMovesNear();
}

/// Solids whose boxes the fabric meets on its way, or comes as near as so many radii; without moves, where the solids are at the end.
void SolidLimiter::findNear(Points x, std::span<const Vec3> u, double radii)
{
    isNear_ = false;
    const Eigen::AlignedBox3d fabric = boxAround(x, u);
    const double reach = radii * std::ranges::max(fabric_->radius);
    for (Body& body : bodies_) {
        const Eigen::AlignedBox3d solid = body.shape.bounds();
        Eigen::AlignedBox3d seen;
        for (const Eigen::Isometry3d* to : {u.empty() ? &body.toEnd : &body.toBegin, &body.toEnd})
            for (int c = 0; c < 8; ++c) seen.extend(*to * fabric.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));
        body.isNear = (seen.min().array() - reach <= solid.max().array()).all() && (seen.max().array() + reach >= solid.min().array()).all();
        isNear_ = isNear_ || body.isNear;
    }
}

/// Distances at the start, and what may be left of them on the way; without moves, those where the solids are at the end.
void SolidLimiter::measure(Points x, std::span<const Vec3> u)
{
    for (Body& body : bodies_) {
        if (!body.isNear) continue;
        parallelFor(x.size(), 512, [&](std::size_t v) {
            const Vec3 from = (u.empty() ? body.toEnd : body.toBegin) * x[v];
            body.distance[v] = body.shape.distance(from);
            body.clear[v] = body.distance[v];
            if (!u.empty()) body.clear[v] -= body.steepest * (body.toEnd * (x[v] + u[v]) - from).norm();
        });
    }
}

SweptElement SolidLimiter::swept(const Body& body, Points x, std::span<const Vec3> u, const int* vertices, int corners) const
{
    SweptElement element;
    element.corners = corners;
    for (int c = 0; c < corners; ++c) {
        const int v = vertices[c];
        element.from[c] = body.toBegin * x[v];
        element.to[c] = body.toEnd * (x[v] + u[v]);
    }
    return element;
}

double SolidLimiter::leastRadius(const int* vertices, int corners) const
{
    double radius = fabric_->radius[vertices[0]];
    for (int c = 1; c < corners; ++c) radius = std::min(radius, fabric_->radius[vertices[c]]);
    return radius;
}

/// Can any point of an element come as near as `distance`? A quick look from its corners: no point of an edge is further from both ends than
/// half its length, none of a face further from its nearest corner than its longest side by √3.
bool SolidLimiter::mayTouch(const Body& body, Points x, const int* vertices, int corners, double distance) const
{
    double clear = std::numeric_limits<double>::infinity(), longest = 0.0;
    for (int c = 0; c < corners; ++c) {
        clear = std::min(clear, body.clear[vertices[c]]);
        longest = std::max(longest, (x[vertices[c]] - x[vertices[(c + 1) % corners]]).squaredNorm());
    }
    const double size = std::sqrt(corners == 3 ? longest / 3.0 : 0.25 * longest);
    return clear - body.steepest * size < distance;
}

/// Is any of them pinned?
bool SolidLimiter::isHeld(const int* vertices, int corners) const
{
    return std::any_of(vertices, vertices + corners, [&](int v) { return fabric_->pinned[v] != 0; });
}

/// Appends an element that comes too near, or its parts, if the element itself begins inside of the solid or is left to pins.
void SolidLimiter::checkElement(int number, const Part& whole, Points x, std::span<const Vec3> u, std::vector<Blocked>& out) const
{
    const int* vertices = whole.vertices;
    const int corners = whole.corners;
    if (corners == 1 && fabric_->pinned[*vertices]) return;
    const Body& body = bodies_[number];
    const double kept = kCoreDistance * leastRadius(vertices, corners);
    const auto checkParts = [&] {
        for (int c = 0; corners > 1 && c < corners; ++c) {
            const std::array<int, 2> part = {vertices[c], vertices[(c + 1) % corners]};
            checkElement(number, {whole.element, part.data(), corners - 1}, x, u, out);
        }
    };
    if (isLeft_[whole.element] && isHeld(vertices, corners)) return checkParts();
    if (std::any_of(vertices, vertices + corners, [&](int v) { return body.distance[v] <= 0.0; })) return checkParts();
    const SweptElement element = swept(body, x, u, vertices, corners);
    SafePart safe = solids::safePart(body.shape, element, kept);
    if (safe.part >= 1.0) return;
    const Nearest nearest = nearestTo(body.shape, {element.from.data(), static_cast<std::size_t>(corners)}, kept);
    if (nearest.reached <= 0.0) return checkParts();
    double lack = 0.0;
    if (kKept * nearest.least < kept) {
        safe = solids::safePart(body.shape, element, kKept * std::max(0.0, nearest.least));
        const Nearest last = nearestTo(body.shape, {element.to.data(), static_cast<std::size_t>(corners)}, kept);
        if (safe.part >= 1.0) {
            if (last.reached >= std::min(kept, (1.0 - kStays) * nearest.least)) return;
            safe.weights = last.weights;
            lack = kept - last.reached;
        } else {
            lack = std::max(0.0, kept - nearest.least);
        }
    }
    Blocked& blocked = out.emplace_back();
    blocked.body = number;
    blocked.element = whole.element;
    blocked.corners = corners;
    std::copy_n(vertices, corners, blocked.vertices.begin());
    blocked.part = safe.part;
    blocked.lack = lack;
    blocked.weights = safe.weights;
}

/// Appends what look(body, element, out) gives for each solid that is near and each element that can move, in their order.
template <class Found, class Look>
void SolidLimiter::collect(const Elements& elements, std::vector<std::vector<Found>>& ofChunk, std::vector<Found>& all, Look&& checkElement) const
{
    const Chunks chunks(elements.size());
    ofChunk.resize(std::max(ofChunk.size(), chunks.count()));
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (!bodies_[b].isNear) continue;
        parallelFor(chunks.count(), [&](std::size_t chunk) {
            ofChunk[chunk].clear();
            for (std::size_t e = chunks.begin(chunk); e < chunks.end(chunk); ++e) {
                const std::array<int, 3>& v = elements[e];
                const bool isFree = !fabric_->pinned[v[0]] || !fabric_->pinned[v[1]] || (v[2] >= 0 && !fabric_->pinned[v[2]]);
                if (isFree) checkElement(static_cast<int>(b), static_cast<int>(e), ofChunk[chunk]);
            }
        });
        for (std::size_t c = 0; c < chunks.count(); ++c) all.insert(all.end(), ofChunk[c].begin(), ofChunk[c].end());
    }
}

void SolidLimiter::findBlocked(Points x, std::span<const Vec3> u)
{
    blocked_.clear();
    collect(elements_, ofChunk_, blocked_, [&](int body, int element, std::vector<Blocked>& out) {
        const std::array<int, 3>& vertices = elements_[element];
        const int corners = vertices[2] < 0 ? 2 : 3;
        if (mayTouch(bodies_[body], x, vertices.data(), corners, kCoreDistance * leastRadius(vertices.data(), corners)))
            checkElement(body, {element, vertices.data(), corners}, x, u, out);
    });
}

/// Appends the nearest point of an element, if it touches, and no vertex does so for it.
void SolidLimiter::addNearest(int solid, int element, Points x, const std::array<int, 3>& vertices, std::vector<NearestPoint>& out) const
{
    const Body& body = bodies_[solid];
    const int corners = vertices[2] < 0 ? 2 : 3;
    const double radius = leastRadius(vertices.data(), corners);
    if (!mayTouch(body, x, vertices.data(), corners, radius)) return;
    std::array<Vec3, 3> at;
    double nearestCorner = std::numeric_limits<double>::infinity();
    for (int c = 0; c < corners; ++c) {
        at[c] = body.toEnd * x[vertices[c]];
        nearestCorner = std::min(nearestCorner, body.distance[vertices[c]]);
    }
    const Nearest nearest = nearestTo(body.shape, {at.data(), static_cast<std::size_t>(corners)}, radius);
    if (nearest.reached <= 0.0 || nearest.reached >= std::min(radius, nearestCorner)) return;
    if (nearest.weights.maxCoeff() < kInterior) out.push_back({element, solid, corners, vertices, nearest.weights, radius});
}

const std::vector<NearestPoint>& SolidLimiter::nearestPoints(Points x)
{
    nearest_.clear();
    if (bodies_.empty()) return nearest_;
    findNear(x, {});
    if (!isNear_) return nearest_;
    measure(x, {});
    // Of a face that lies across an edge of the solid any point along it may be nearest; those of the face's own edges are where it rests.
    for (const Elements* elements : {&elements_, &clothEdges_}) {
        const int first = elements == &elements_ ? 0 : static_cast<int>(elements_.size());
        collect(*elements, nearestOfChunk_, nearest_,
                [&](int body, int element, std::vector<NearestPoint>& out) { addNearest(body, first + element, x, (*elements)[element], out); });
    }
    std::ranges::sort(nearest_, {}, [](const NearestPoint& p) { return std::pair(p.element, p.body); });
    return nearest_;
}

}  // namespace sim
