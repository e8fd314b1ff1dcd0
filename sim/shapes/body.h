#pragma once

#include "sim/shapes/shape.h"

#include <limits>

namespace sim {

/// What a Shape is made of: one subclass per kind of body. For shape*.cpp only.
struct Shape::Body {
    using Pointer = std::shared_ptr<const Body>;

    virtual ~Body() = default;
    virtual double distance(const Vec3& x) const = 0;
    virtual Vec3 normal(const Vec3& x) const = 0;

    /// Shape::over, for a body whose distance is a convex function: never below its tangent plane.
    virtual Look over(std::span<const Vec3> corners, double enough) const;
    /// Where the distance, a convex function that falls at a, is lowest on the way from a to b: from where it rises if b is not it.
    virtual Vec3 lowestBetween(const Vec3& a, const Vec3& b) const;
    /// Upper bound of the distance on the hull of these points; a convex function is largest at one of them.
    virtual double mostOver(std::span<const Vec3> corners) const;
    virtual double steepest() const { return 1.0; }

    /// Bounds after a rigid motion.
    virtual Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& transform) const = 0;

    /// The body after a rigid motion, or null where it can only be had by moving the points that are asked about.
    virtual Pointer movedBody(const Eigen::Isometry3d&) const { return nullptr; }
    virtual std::optional<AxisBox> axisBox() const { return std::nullopt; }
    /// Null unless this is the outside of another body.
    virtual const Pointer* inner() const { return nullptr; }
};

using BodyPointer = Shape::Body::Pointer;

inline Vec3 meanOf(std::span<const Vec3> points)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& x : points) sum += x;
    return sum / static_cast<double>(points.size());
}

/// The body after a rigid motion (shape_operators.cpp).
BodyPointer moveBody(const BodyPointer& body, const Eigen::Isometry3d& transform);

inline Eigen::AlignedBox3d unboundedBox()
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
}

/// Bounds of a box after a rigid motion.
inline Eigen::AlignedBox3d movedBounds(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& transform)
{
    if (box.isEmpty()) return box;
    if (!box.min().allFinite() || !box.max().allFinite()) return unboundedBox();
    const Vec3 center = transform * box.center();
    const Vec3 half = transform.linear().cwiseAbs() * (0.5 * box.sizes());
    return {center - half, center + half};
}

}  // namespace sim
