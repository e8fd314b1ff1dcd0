#include "sim/shapes/shape.h"

#include "sim/shapes/body.h"

#include <algorithm>

namespace sim {

double Shape::distance(const Vec3& x) const { return body_ ? body_->distance(x) : std::numeric_limits<double>::infinity(); }

Vec3 Shape::normal(const Vec3& x) const { return body_ ? body_->normal(x) : Vec3(Vec3::UnitX()); }

Shape::Look Shape::over(std::span<const Vec3> corners, double enough) const
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return body_ ? body_->over(corners, enough) : Look{kInfinity, kInfinity};
}

Vec3 Shape::Body::lowestBetween(const Vec3& a, const Vec3& b) const
{
    constexpr int kHalvings = 14;
    const Vec3 way = b - a;
    if (normal(b).dot(way) <= 0.0) return b;
    double low = 0.0, high = 1.0;
    for (int n = 0; n < kHalvings; ++n) {
        const double t = 0.5 * (low + high);
        (normal(a + t * way).dot(way) > 0.0 ? high : low) = t;
    }
    return a + 0.5 * (low + high) * way;
}

double Shape::steepest() const { return body_ ? body_->steepest() : 0.0; }

/// The tangent plane in the middle, and then, while it bounds far less than the distance where it touches, those at the lowest points on the
/// ways from there to the corner that lies deepest below each plane (Frank and Wolfe 1956). An edge of the body that runs along a hull is
/// found by the second of them.
Shape::Look Shape::Body::over(std::span<const Vec3> corners, double enough) const
{
    constexpr int kPlanes = 5;
    constexpr double kNear = 0.05;
    Vec3 x = meanOf(corners);
    double at = distance(x);
    Look look{-std::numeric_limits<double>::infinity(), at};
    for (int plane = 0; plane < kPlanes; ++plane) {
        const Vec3 n = normal(x);
        double slope = 0.0;
        Vec3 deepest = x;
        for (const Vec3& corner : corners)
            if (const double s = n.dot(corner - x); s < slope) slope = s, deepest = corner;
        look.least = std::max(look.least, at + slope);
        if (at <= 0.0 || look.least >= std::min(enough, (1.0 - kNear) * at)) break;
        x = lowestBetween(x, deepest);
        at = distance(x);
    }
    return look;
}

double Shape::Body::mostOver(std::span<const Vec3> corners) const
{
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : corners) most = std::max(most, distance(x));
    return most;
}

Eigen::AlignedBox3d Shape::bounds() const { return body_ ? body_->bounds(Eigen::Isometry3d::Identity()) : Eigen::AlignedBox3d(); }

std::optional<Shape::AxisBox> Shape::axisBox() const { return body_ ? body_->axisBox() : std::nullopt; }

bool Shape::isInverted() const { return body_ && body_->inner() != nullptr; }

Shape Shape::moved(const Eigen::Isometry3d& transform) const { return body_ ? Shape(moveBody(body_, transform)) : Shape(); }

std::vector<std::shared_ptr<const Shape::Body>> Shape::bodies(const std::vector<Shape>& shapes)
{
    std::vector<std::shared_ptr<const Body>> found;
    for (const Shape& s : shapes)
        if (!s.empty()) found.push_back(s.body_);
    return found;
}

}  // namespace sim
