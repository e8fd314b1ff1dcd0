#include "sim/core/check.h"
#include "sim/shapes/body.h"

#include <cmath>

namespace sim {

namespace {

void requireSize(double size, const char* what)
{
    if (!(size >= 0.0) || !std::isfinite(size))
        throw InputError(std::string(what) + " must be a finite number, 0 or more, not " + std::to_string(size));
}

void requireFinite(const Vec3& x, const char* what)
{
    if (!x.allFinite()) throw InputError(std::string(what) + " must have finite coordinates");
}

double signOf(double x) { return x < 0.0 ? -1.0 : 1.0; }

bool isTranslation(const Eigen::Isometry3d& t) { return t.linear() == Mat3::Identity(); }

/// Box with round edges, its faces along the axes.
struct Box final : Shape::Body {
    Vec3 center, half;
    double round;

    Box(const Vec3& c, const Vec3& h, double r) : center(c), half(h), round(r) {}

    double distance(const Vec3& x) const override
    {
        const Vec3 d = (x - center).cwiseAbs() - half;
        const double deepest = d.maxCoeff();
        return (deepest <= 0.0 ? deepest : d.cwiseMax(0.0).norm()) - round;
    }
    Vec3 normal(const Vec3& x) const override
    {
        const Vec3 q = x - center;
        const Vec3 d = q.cwiseAbs() - half;
        Eigen::Index axis;
        Vec3 n = Vec3::Zero();
        if (d.maxCoeff(&axis) > 0.0) n = d.cwiseMax(0.0).stableNormalized();
        else n[axis] = 1.0;
        for (int a = 0; a < kAxes; ++a) n[a] *= signOf(q[a]);
        return n;
    }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        const Vec3 c = t * center;
        const Vec3 reach = t.linear().cwiseAbs() * half + Vec3::Constant(round);
        return {c - reach, c + reach};
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override
    {
        if (!isTranslation(t)) return nullptr;
        return std::make_shared<Box>(center + t.translation(), half, round);
    }
    std::optional<Shape::AxisBox> axisBox() const override
    {
        const Vec3 outer = half + Vec3::Constant(round);
        return Shape::AxisBox{{center - outer, center + outer}, false, round};
    }
};

struct Ball final : Shape::Body {
    Vec3 center;
    double radius;

    Ball(const Vec3& c, double r) : center(c), radius(r) {}

    double distance(const Vec3& x) const override { return (x - center).norm() - radius; }
    Vec3 normal(const Vec3& x) const override
    {
        const Vec3 q = x - center;
        return q.squaredNorm() > 0.0 ? Vec3(q.stableNormalized()) : Vec3(Vec3::UnitX());
    }
    Vec3 lowestBetween(const Vec3& a, const Vec3& b) const override
    {
        const Vec3 way = b - a;
        return a + std::min(1.0, (center - a).dot(way) / way.squaredNorm()) * way;
    }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        const Vec3 c = t * center;
        return {c - Vec3::Constant(radius), c + Vec3::Constant(radius)};
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return std::make_shared<Ball>(t * center, radius); }
};

struct Capsule final : Shape::Body {
    Vec3 a, along;  ///< one end of the core and the way to the other
    double radius, inverseSquare;

    Capsule(const Vec3& from, const Vec3& to, double r) : a(from), along(to - from), radius(r)
    {
        const double square = along.squaredNorm();
        inverseSquare = square > 0.0 ? 1.0 / square : 0.0;
    }

    Vec3 fromCore(const Vec3& x) const
    {
        const Vec3 q = x - a;
        return q - std::clamp(q.dot(along) * inverseSquare, 0.0, 1.0) * along;
    }
    double distance(const Vec3& x) const override { return fromCore(x).norm() - radius; }
    Vec3 normal(const Vec3& x) const override
    {
        const Vec3 q = fromCore(x);
        if (q.squaredNorm() > 0.0) return q.stableNormalized();
        return along.squaredNorm() > 0.0 ? Vec3(along.unitOrthogonal()) : Vec3(Vec3::UnitX());
    }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        const Vec3 p = t * a, q = t * Vec3(a + along), reach = Vec3::Constant(radius);
        return {p.cwiseMin(q) - reach, p.cwiseMax(q) + reach};
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return std::make_shared<Capsule>(t * a, t * Vec3(a + along), radius); }
};

struct Cylinder final : Shape::Body {
    Vec3 center, axis;
    double radius, half, round;

    Cylinder(const Vec3& c, const Vec3& a, double r, double h, double edge) : center(c), axis(a), radius(r), half(h), round(edge) {}

    double distance(const Vec3& x) const override
    {
        const Vec3 q = x - center;
        const double y = q.dot(axis);
        const double side = (q - y * axis).norm() - (radius - round), top = std::abs(y) - half;
        const double deepest = std::max(side, top), besides = std::max(side, 0.0), above = std::max(top, 0.0);
        return (deepest <= 0.0 ? deepest : std::sqrt(besides * besides + above * above)) - round;
    }
    Vec3 normal(const Vec3& x) const override
    {
        const Vec3 q = x - center;
        const double y = q.dot(axis);
        const Vec3 across = q - y * axis;
        const double r = across.norm(), side = r - (radius - round), top = std::abs(y) - half;
        const Vec3 outward = r > 0.0 ? Vec3(across / r) : Vec3(axis.unitOrthogonal());
        if (side <= 0.0 && top <= 0.0) return side > top ? outward : Vec3(signOf(y) * axis);
        return (std::max(side, 0.0) * outward + std::max(top, 0.0) * signOf(y) * axis).stableNormalized();
    }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        const Vec3 c = t * center, a = t.linear() * axis;
        const Vec3 disc = (Vec3::Ones() - a.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
        const Vec3 reach = half * a.cwiseAbs() + (radius - round) * disc + Vec3::Constant(round);
        return {c - reach, c + reach};
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override
    {
        return std::make_shared<Cylinder>(t * center, t.linear() * axis, radius, half, round);
    }
};

}  // namespace

Shape Shape::box(const Vec3& center, const Vec3& half) { return roundedBox(center, half, 0.0); }

Shape Shape::roundedBox(const Vec3& center, const Vec3& half, double round)
{
    requireFinite(center, "a box's center");
    for (double h : half) requireSize(h, "a box's half size");
    requireSize(round, "a box's rounding");
    return Shape(std::make_shared<Box>(center, half, round));
}

Shape Shape::ball(const Vec3& center, double radius)
{
    requireFinite(center, "a ball's center");
    requireSize(radius, "a ball's radius");
    return Shape(std::make_shared<Ball>(center, radius));
}

Shape Shape::capsule(const Vec3& a, const Vec3& b, double radius)
{
    requireFinite(a, "a capsule's end");
    requireFinite(b, "a capsule's end");
    requireSize(radius, "a capsule's radius");
    return Shape(std::make_shared<Capsule>(a, b, radius));
}

Shape Shape::cylinder(const Vec3& center, const Vec3& axis, double radius, double half, double round)
{
    constexpr double kUnitTolerance = 1.0e-6;
    requireFinite(center, "a cylinder's center");
    requireSize(radius, "a cylinder's radius");
    requireSize(half, "a cylinder's half height");
    requireSize(round, "a cylinder's rounding");
    if (!(std::abs(axis.norm() - 1.0) < kUnitTolerance)) throw InputError("a cylinder's axis must be a unit vector");
    if (round > radius) throw InputError("a cylinder's rounding must not be more than its radius");
    return Shape(std::make_shared<Cylinder>(center, axis.normalized(), radius, half, round));
}

}  // namespace sim
