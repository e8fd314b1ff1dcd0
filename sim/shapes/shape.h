#pragma once

#include "sim/core/types.h"

#include <Eigen/Geometry>

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sim {

/// A solid body given by its signed distance, negative inside. Immutable; copies share the body.
/// Distances of primitives are exact; of unions, intersections and differences they are bounds outside of which
/// nothing of the body lies (min, max): never more than the distance to the surface.
/// Shapes that make no sense (negative or infinite sizes, an axis that is not a unit vector) throw InputError.
class Shape {
 public:
    Shape() = default;  ///< empty: infinitely far from everywhere

    static Shape box(const Vec3& center, const Vec3& half);
    /// The box with half sizes `half`, grown by `round` on every side, with round edges.
    static Shape roundedBox(const Vec3& center, const Vec3& half, double round);
    static Shape ball(const Vec3& center, double radius);
    /// All points within radius of the segment from a to b.
    static Shape capsule(const Vec3& a, const Vec3& b, double radius);
    /// Solid cylinder of half height `half` along a unit axis, with edges rounded by `round` (added on top and bottom,
    /// not on the radius: the side stays at `radius`).
    static Shape cylinder(const Vec3& center, const Vec3& axis, double radius, double half, double round);
    /// A closed triangle mesh, sampled on a lattice of pitch `cell` that reaches 3 cells further than the mesh;
    /// trilinear in between. Inside is where the winding number is above a half, once mendSolid has mended the mesh:
    /// holes of less than 2 cells, doubled faces and faces or parts turned inside out do no harm, and `notes` takes a
    /// line about them; an open mesh is no solid. Outside of the lattice: the distance to it plus the value there, which
    /// is no less than the distance to the mesh. Throws InputError for what
    /// cannot be mended, and when the lattice has more than 5e8 nodes.
    static Shape mesh(const std::vector<Vec3>& vertices, const std::vector<Vec3i>& triangles, double cell, std::vector<std::string>* notes = nullptr);

    static Shape unite(const std::vector<Shape>& shapes);
    static Shape intersect(const std::vector<Shape>& shapes);
    /// The first without all the others.
    static Shape subtract(const std::vector<Shape>& shapes);
    Shape inverted() const;
    bool isInverted() const;  ///< the outside of another shape, which inverted() gives
    /// The shape after a rigid motion. Boxes stay axis-aligned boxes under translations.
    Shape moved(const Eigen::Isometry3d& transform) const;

    bool empty() const { return body_ == nullptr; }
    double distance(const Vec3& x) const;  ///< [cm]; +∞ for the empty shape
    /// Unit gradient of the distance: outward. Where it does not exist (the middle of a ball) any unit vector along
    /// which the distance does not fall.
    Vec3 normal(const Vec3& x) const;
    /// One look at the distance all over the convex hull of some points.
    struct Look {
        double least;   ///< lower bound [cm]
        double middle;  ///< what it is at the points' mean [cm]
    };
    /// Looks at the hull of up to kMostCorners points. The bound is exact for a flat surface and for a point; its error falls with the
    /// square of the hull's size where the surface is smooth, and by halving the hull it comes as near as one likes anywhere.
    /// @param enough  how much larger the bound could be is not looked for [cm]
    Look over(std::span<const Vec3> corners, double enough = std::numeric_limits<double>::infinity()) const;
    static constexpr std::size_t kMostCorners = 6;
    /// The distance changes by no more than this times the way [-]: 1, but for meshes, between whose samples it may be steeper.
    double steepest() const;

    /// Tight for primitives; the common part of the children's for an intersection. Inverted shapes have corners at ±∞,
    /// the empty shape an empty box.
    Eigen::AlignedBox3d bounds() const;

    /// The box, if this is an axis-aligned box, or the inside of one (then `inside` is set).
    struct AxisBox {
        Eigen::AlignedBox3d box;
        bool inside = false;
        double round = 0.0;  ///< radius of its edges [cm]
    };
    std::optional<AxisBox> axisBox() const;

    struct Body;

 private:
    explicit Shape(std::shared_ptr<const Body> body) : body_(std::move(body)) {}
    /// The bodies of the shapes that are not empty.
    static std::vector<std::shared_ptr<const Body>> bodies(const std::vector<Shape>& shapes);
    std::shared_ptr<const Body> body_;
};

}  // namespace sim
