#include "sim/shapes/shape.h"

#include "sim/shapes/body.h"

#include <algorithm>

namespace sim {

double Shape::distance(const Vec3& x) const
{
    return body_ ? body_->distance(x) : std::numeric_limits<double>::infinity();
}

Vec3 Shape::normal(const Vec3& x) const
{
    return body_ ? body_->normal(x) : Vec3(Vec3::UnitX());
}

Shape::Look Shape::over(std::span<const Vec3> corners) const
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return body_ ? body_->over(corners) : Look{kInfinity, kInfinity};
}

double Shape::steepest() const
{
    return body_ ? body_->steepest() : 0.0;
}

Shape::Look Shape::Body::over(std::span<const Vec3> corners) const
{
    const Vec3 middle = meanOf(corners), n = normal(middle);
    const double at = distance(middle);
    double slope = 0.0;
    for (const Vec3& x : corners) slope = std::min(slope, n.dot(x - middle));
    return {at + slope, at};
}

double Shape::Body::mostOver(std::span<const Vec3> corners) const
{
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : corners) most = std::max(most, distance(x));
    return most;
}

Eigen::AlignedBox3d Shape::bounds() const
{
    return body_ ? body_->bounds(Eigen::Isometry3d::Identity()) : Eigen::AlignedBox3d();
}

std::optional<Shape::AxisBox> Shape::axisBox() const
{
    return body_ ? body_->axisBox() : std::nullopt;
}

bool Shape::isInverted() const
{
    return body_ && body_->inner() != nullptr;
}

Shape Shape::moved(const Eigen::Isometry3d& transform) const
{
    return body_ ? Shape(moveBody(body_, transform)) : Shape();
}

std::vector<std::shared_ptr<const Shape::Body>> Shape::bodies(const std::vector<Shape>& shapes)
{
    std::vector<std::shared_ptr<const Body>> found;
    for (const Shape& s : shapes)
        if (!s.empty()) found.push_back(s.body_);
    return found;
}

}  // namespace sim
