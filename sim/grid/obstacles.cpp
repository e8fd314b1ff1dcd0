#include "sim/grid/obstacles.h"

#include <algorithm>
#include <cmath>

namespace sim {

void Obstacles::add(const Shape& shape, const Motion& motion)
{
    Body body{shape, motion, {}, {}, {}};
    body.now = motion.transform(0.0);
    body.other = body.now;
    body.toShape = body.now.inverse();
    steepest_ = std::max(steepest_, body.shape.steepest());
    bodies_.push_back(std::move(body));
    const auto box = motion.isStatic() ? shape.axisBox() : std::nullopt;
    if (!box || !box->inside) return;
    for (int axis = 0; axis < kAxes; ++axis) {
        walls_.push_back({axis, box->box.min()[axis], false});
        walls_.push_back({axis, box->box.max()[axis], true});
    }
    bodies_.back().isVessel = true;
    vessels_.push_back({box->box.center(), 0.5 * box->box.sizes() - Vec3::Constant(box->round), box->round});
}

void Obstacles::startAt(double t0, double t1)
{
    begin(t0, t1);
    place(t1, t0);
}

void Obstacles::moveTo(double t0, double t1)
{
    begin(t0, t1);
    place(t0, t1);
}

/// Find what moves in a step. A step may be begun again.
void Obstacles::begin(double t0, double t1)
{
    if (started_ != t0) {
        startedBefore_ = std::min(started_, t0);
        started_ = t0;
    }
    anyMoving_ = anyDisplaced_ = false;
    for (Body& body : bodies_) {
        body.moving = body.motion.moves(t0, t1);
        body.displaced = body.motion.moves(startedBefore_, t1);
        anyMoving_ = anyMoving_ || body.moving;
        anyDisplaced_ = anyDisplaced_ || body.displaced;
    }
}

void Obstacles::place(double there, double now)
{
    interval_ = now - there;
    for (Body& body : bodies_) {
        body.other = body.motion.transform(there);
        body.now = body.motion.transform(now);
        body.toShape = body.now.inverse();
    }
}

double Obstacles::distance(const Vec3& x) const
{
    double d = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_) d = std::min(d, body.shape.distance(body.motion.isStatic() ? x : body.toShape * x));
    return d;
}

/// A distance that may be more than the way to the surface, as that of a mesh far away, is trusted no further than its slope lets it: cubes
/// that it leaves in doubt are halved.
static bool reaches(const Shape& shape, const Eigen::Isometry3d& toShape, const Vec3& x, double halfEdge, double within, int halvings)
{
    const double distance = shape.distance(toShape * x), corner = std::sqrt(3.0) * halfEdge, steepest = std::max(1.0, shape.steepest());
    if (distance >= within + steepest * corner) return false;
    if (distance < within + corner || halvings == 0) return true;
    for (int n = 0; n < 8; ++n) {
        const Vec3 aside = 0.5 * halfEdge * Vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1);
        if (reaches(shape, toShape, x + aside, 0.5 * halfEdge, within, halvings - 1)) return true;
    }
    return false;
}

bool Obstacles::reach(const Vec3& x, double halfEdge, double within, Which which) const
{
    constexpr int kHalvings = 3;
    return std::ranges::any_of(
        bodies_, [&](const Body& body) { return body.isOne(which) && reaches(body.shape, body.toShape, x, halfEdge, within, kHalvings); });
}

int Obstacles::nearest(const Vec3& x) const { return count() == 1 ? 0 : static_cast<int>(nearestBody(x) - bodies_.data()); }

const Obstacles::Body* Obstacles::nearestBody(const Vec3& x) const
{
    const Body* best = bodies_.empty() ? nullptr : bodies_.data();
    double least = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_) {
        const double d = body.shape.distance(body.toShape * x);
        if (d < least) {
            least = d;
            best = &body;
        }
    }
    return best;
}

Vec3 Obstacles::normal(const Vec3& x) const
{
    const Body* body = nearestBody(x);
    return body == nullptr ? Vec3::Zero() : Vec3(body->now.linear() * body->shape.normal(body->toShape * x));
}

constexpr double kLeastStride = 1.0e-4;   ///< least stride along a path, whose length stays finite in steps that fail [lengths of the path]
constexpr double kBarelyInside = 1.0e-3;  ///< as little in a solid is on its surface [resolutions]

/// start(body): where the path starts, in the space of the body's shape.
template <class Start>
std::optional<Obstacles::Contact> Obstacles::findContact(const Vec3& to, double resolution, Start&& start) const
{
    std::optional<Contact> first;
    double earliest = 1.0;  // share of the path: until then it is outside of all bodies
    for (const Body& body : bodies_) {
        const Vec3 a = start(body), way = body.toShape * to - a;
        const double length = way.norm(), least = std::max(resolution, kLeastStride * length), steepest = std::max(1.0, body.shape.steepest());
        if (!std::isfinite(length)) continue;
        double distance = body.shape.distance(a);
        if (distance < -kBarelyInside * resolution || distance > steepest * length) continue;
        // So far it is safe: the distance never changes faster than the point moves, or, of a mesh, than at its steepest.
        for (double gone = 0.0; gone < std::min(earliest * length + least, length);) {
            gone = std::min(gone + std::max(distance / steepest, least), length);
            distance = body.shape.distance(a + gone / length * way);
            if (distance > 0.0) {
                if (gone >= length) break;
                continue;
            }
            const double share = std::max(0.0, gone - least) / length;
            if (share < earliest || !first) {
                earliest = share;
                const Vec3 at = a + share * way;
                first = Contact{body.now * at, body.now.linear() * body.shape.normal(at), share};
            }
            break;
        }
    }
    return first;
}

std::optional<Obstacles::Contact> Obstacles::firstContact(const Path& way, const Vec3& to, double resolution) const
{
    return findContact(to, resolution, [&](const Body& body) {
        Vec3 x = body.moving ? Vec3(body.other.inverse() * way.start_) : Vec3(body.toShape * way.start_);
        for (int n = 0; n < way.count_; ++n) x += way.segments_[n].share * (body.toShape * way.segments_[n].to - x);
        return x;
    });
}

std::optional<Obstacles::Contact> Obstacles::firstContactAtEnd(const Vec3& from, const Vec3& to, double resolution) const
{
    return findContact(to, resolution, [&](const Body& body) -> Vec3 { return body.toShape * from; });
}

double Obstacles::farthestMove(const Vec3& x, double halfEdge) const
{
    double farthest = 0.0;
    for (const Body& body : bodies_) {
        if (!body.moving) continue;
        const Eigen::Isometry3d move = body.now * body.other.inverse();
        for (int n = 0; n < 8; ++n) {
            const Vec3 corner = x + halfEdge * Vec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1);
            farthest = std::max(farthest, (move * corner - corner).norm());
        }
    }
    return farthest;
}

Vec3 Obstacles::velocityOf(const Body& body, const Vec3& x) const
{
    if (!body.moving || interval_ == 0.0) return Vec3::Zero();
    return (x - body.other * (body.toShape * x)) / interval_;
}

Vec3 Obstacles::velocity(const Vec3& x) const
{
    const Body* body = nearestBody(x);
    return body == nullptr ? Vec3::Zero() : velocityOf(*body, x);
}

double Obstacles::distance(const Vec3& x, int solid) const
{
    return solid == kAll ? distance(x) : bodies_[solid].shape.distance(bodies_[solid].toShape * x);
}

Vec3 Obstacles::normal(const Vec3& x, int solid) const
{
    return bodies_[solid].now.linear() * bodies_[solid].shape.normal(bodies_[solid].toShape * x);
}

Vec3 Obstacles::velocity(const Vec3& x, int solid) const { return velocityOf(bodies_[solid], x); }

std::optional<int> planeOfFaces(const BlockGrid& grid, const Obstacles::Wall& wall)
{
    constexpr double kInPlane = 1.0e-6;  // [cells]
    const double inCells = (wall.at - grid.origin[wall.axis]) / grid.dx;
    const double plane = std::round(inCells);
    if (std::abs(inCells - plane) > kInPlane) return std::nullopt;
    return static_cast<int>(plane);
}

}  // namespace sim
