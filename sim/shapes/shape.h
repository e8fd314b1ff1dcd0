#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

namespace sim {

/// A solid body given by its signed distance, negative inside. Immutable; copies share the body.
/// Distances of primitives are exact; of unions, intersections and differences they are bounds outside of which
/// nothing of the body lies (min, max).
class Shape {
 public:
    Shape() = default;  ///< empty: infinitely far from everywhere

    static Shape box(const Vec3& center, const Vec3& half);
    /// The box with half sizes `half`, grown by `round` on every side, with round edges.
    static Shape roundedBox(const Vec3& center, const Vec3& half, double round);
    static Shape ball(const Vec3& center, double radius);
    /// All points within radius of the segment from a to b.
    static Shape capsule(const Vec3& a, const Vec3& b, double radius);
    /// Solid cylinder of half height `half` along a unit axis, with edges rounded by `round` (added on top and bottom, not
    /// on the radius: the side stays at `radius`).
    static Shape cylinder(const Vec3& center, const Vec3& axis, double radius, double half, double round);
    /// A closed triangle mesh, sampled on a lattice of pitch `cell`.
    static Shape mesh(const std::vector<Vec3>& vertices, const std::vector<Vec3i>& triangles, double cell);

    static Shape unite(std::vector<Shape> shapes);
    static Shape intersect(std::vector<Shape> shapes);
    /// The first without all the others.
    static Shape subtract(std::vector<Shape> shapes);
    Shape inverted() const;
    Shape moved(const Eigen::Isometry3d& transform) const;

    bool empty() const { return body_ == nullptr; }
    double distance(const Vec3& x) const;           ///< [cm]
    Vec3 normal(const Vec3& x) const;               ///< unit gradient of the distance
    Eigen::AlignedBox3d bounds() const;             ///< unbounded for inverted shapes

    /// The box, if this is an axis-aligned box with sharp edges, or the inside of one (then `inside` is set):
    /// its walls are planes, which the solver can mirror exactly.
    struct AxisBox {
        Eigen::AlignedBox3d box;
        bool inside = false;
    };
    std::optional<AxisBox> axisBox() const;

    struct Body;

 private:
    explicit Shape(std::shared_ptr<const Body> body) : body_(std::move(body)) {}
    std::shared_ptr<const Body> body_;
};

}  // namespace sim
