#include "sim/grid/obstacles.h"

namespace sim {

void Obstacles::add(const Shape& shape, const Motion& motion)
{
    Body body{shape, motion, {}, {}, {}, false};
    body.now = motion.transform(0.0);
    body.before = body.now;
    body.toShape = body.now.inverse();
    bodies_.push_back(std::move(body));
    const auto box = motion.isStatic() ? shape.axisBox() : std::nullopt;
    if (!box || !box->inside) return;
    for (int axis = 0; axis < kAxes; ++axis) {
        walls_.push_back({axis, box->box.min()[axis], false});
        walls_.push_back({axis, box->box.max()[axis], true});
    }
}

void Obstacles::moveTo(double t0, double t1)
{
    anyMoving_ = false;
    interval_ = t1 - t0;
    for (Body& body : bodies_) {
        body.moving = body.motion.moves(t0, t1);
        anyMoving_ = anyMoving_ || body.moving;
        body.before = body.motion.transform(t0);
        body.now = body.motion.transform(t1);
        body.toShape = body.now.inverse();
    }
}

double Obstacles::distance(const Vec3& x) const
{
    double d = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_) d = std::min(d, body.shape.distance(body.motion.isStatic() ? x : body.toShape * x));
    return d;
}

double Obstacles::movingDistance(const Vec3& x) const
{
    double d = std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_)
        if (body.moving) d = std::min(d, body.shape.distance(body.toShape * x));
    return d;
}

const Obstacles::Body* Obstacles::nearest(const Vec3& x) const
{
    const Body* best = nullptr;
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
    const Body* body = nearest(x);
    return body == nullptr ? Vec3::Zero() : Vec3(body->now.linear() * body->shape.normal(body->toShape * x));
}

constexpr double kLeastStride = 1.0e-4;  ///< of a search along a path, whose length stays finite in steps that fail [lengths of the path]

/// start(body): where the path starts, in the space of the body's shape.
template <class Start>
std::optional<Obstacles::Contact> Obstacles::meet(const Vec3& to, double resolution, Start&& start) const
{
    std::optional<Contact> first;
    double earliest = 1.0;  // share of the path
    for (const Body& body : bodies_) {
        const Vec3 a = start(body), way = body.toShape * to - a;
        const double length = way.norm(), least = std::max(resolution, kLeastStride * length);
        if (!std::isfinite(length)) continue;
        const double steepest = std::max(1.0, body.shape.steepest());
        double distance = body.shape.distance(a);
        if (distance < 0.0 || distance > steepest * length) continue;
        // So far it is safe: the distance never changes faster than the point moves, or, of a mesh, than at its steepest.
        for (double gone = 0.0; gone < earliest * length;) {
            gone = std::min(gone + std::max(distance / steepest, least), length);
            const Vec3 x = a + gone / length * way;
            distance = body.shape.distance(x);
            if (distance > 0.0) {
                if (gone >= length) break;
                continue;
            }
            if (gone / length < earliest || !first) {
                const Vec3 before = a + std::max(0.0, gone - least) / length * way;
                const Vec3 at = body.shape.distance(before) > 0.0 ? before : x;
                earliest = gone / length;
                first = Contact{body.now * at, body.now.linear() * body.shape.normal(at)};
            }
            break;
        }
    }
    return first;
}

std::optional<Obstacles::Contact> Obstacles::firstContact(const Vec3& from, const Vec3& to, double resolution) const
{
    return meet(to, resolution, [&](const Body& body) -> Vec3 { return body.moving ? body.before.inverse() * from : body.toShape * from; });
}

std::optional<Obstacles::Contact> Obstacles::firstContactAtEnd(const Vec3& from, const Vec3& to, double resolution) const
{
    return meet(to, resolution, [&](const Body& body) -> Vec3 { return body.toShape * from; });
}

Vec3 Obstacles::velocity(const Vec3& x) const
{
    const Body* body = nearest(x);
    if (body == nullptr || !body->moving || interval_ <= 0.0) return Vec3::Zero();
    return (x - body->before * (body->toShape * x)) / interval_;
}

std::optional<int> planeOfFaces(const BlockGrid& grid, const Obstacles::Wall& wall)
{
    constexpr double kInPlane = 1.0e-6;  // [cells]
    const double inCells = (wall.at - grid.origin[wall.axis]) / grid.dx;
    const double plane = std::round(inCells);
    if (std::abs(inCells - plane) > kInPlane) return std::nullopt;
    return static_cast<int>(plane);
}

}  // namespace sim
