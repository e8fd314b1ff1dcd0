#include "sim/shapes/body.h"

#include <algorithm>
#include <array>
#include <utility>

namespace sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A body seen from a moved place.
struct Placed final : Shape::Body {
    BodyPointer body;
    Eigen::Isometry3d toWorld, toBody;

    Placed(BodyPointer b, const Eigen::Isometry3d& t) : body(std::move(b)), toWorld(t), toBody(t.inverse()) {}

    double distance(const Vec3& x) const override { return body->distance(toBody * x); }
    Vec3 normal(const Vec3& x) const override { return toWorld.linear() * body->normal(toBody * x); }
    Shape::Look over(std::span<const Vec3> corners, double enough) const override
    {
        return body->over(std::span(inBody(corners).data(), corners.size()), enough);
    }
    double mostOver(std::span<const Vec3> corners) const override { return body->mostOver(std::span(inBody(corners).data(), corners.size())); }
    std::array<Vec3, Shape::kMostCorners> inBody(std::span<const Vec3> corners) const
    {
        std::array<Vec3, Shape::kMostCorners> moved;
        for (std::size_t i = 0; i < corners.size(); ++i) moved[i] = toBody * corners[i];
        return moved;
    }
    double steepest() const override { return body->steepest(); }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override { return body->bounds(t * toWorld); }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return moveBody(body, t * toWorld); }
};

/// All of space but a body; all of space if that is null.
struct Outside final : Shape::Body {
    BodyPointer body;

    explicit Outside(BodyPointer b) : body(std::move(b)) {}

    double distance(const Vec3& x) const override { return body ? -body->distance(x) : -kInfinity; }
    Vec3 normal(const Vec3& x) const override { return body ? Vec3(-body->normal(x)) : Vec3(Vec3::UnitX()); }
    Shape::Look over(std::span<const Vec3> corners, double) const override
    {
        return {body ? -body->mostOver(corners) : -kInfinity, distance(meanOf(corners))};
    }
    double mostOver(std::span<const Vec3> corners) const override { return body ? -body->over(corners, kInfinity).least : -kInfinity; }
    double steepest() const override { return body ? body->steepest() : 0.0; }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d&) const override { return unboundedBox(); }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return std::make_shared<Outside>(body ? moveBody(body, t) : nullptr); }
    std::optional<Shape::AxisBox> axisBox() const override
    {
        auto box = body ? body->axisBox() : std::nullopt;
        if (box) box->inside = true;  // never the inside of an inside: inverting twice gives the body itself
        return box;
    }
    const BodyPointer* inner() const override { return &body; }
};

using Bodies = std::vector<BodyPointer>;

Bodies moveAll(const Bodies& bodies, const Eigen::Isometry3d& t)
{
    Bodies moved;
    for (const BodyPointer& b : bodies) moved.push_back(moveBody(b, t));
    return moved;
}

double steepestOf(const Bodies& bodies)
{
    double most = 0.0;
    for (const BodyPointer& b : bodies) most = std::max(most, b->steepest());
    return most;
}

struct Union final : Shape::Body {
    Bodies parts;

    explicit Union(Bodies p) : parts(std::move(p)) {}

    double distance(const Vec3& x) const override
    {
        double nearest = kInfinity;
        for (const BodyPointer& b : parts) nearest = std::min(nearest, b->distance(x));
        return nearest;
    }
    Vec3 normal(const Vec3& x) const override
    {
        const Body* active = parts.front().get();
        double nearest = active->distance(x);
        for (const BodyPointer& b : parts)
            if (const double d = b->distance(x); d < nearest) nearest = d, active = b.get();
        return active->normal(x);
    }
    Shape::Look over(std::span<const Vec3> corners, double enough) const override
    {
        Shape::Look look{kInfinity, kInfinity};
        for (const BodyPointer& b : parts) {
            const Shape::Look part = b->over(corners, enough);
            look = {std::min(look.least, part.least), std::min(look.middle, part.middle)};
        }
        return look;
    }
    double mostOver(std::span<const Vec3> corners) const override
    {
        double most = kInfinity;
        for (const BodyPointer& b : parts) most = std::min(most, b->mostOver(corners));
        return most;
    }
    double steepest() const override { return steepestOf(parts); }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        Eigen::AlignedBox3d all;
        for (const BodyPointer& b : parts) all.extend(b->bounds(t));
        return all;
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return std::make_shared<Union>(moveAll(parts, t)); }
};

struct Intersection final : Shape::Body {
    Bodies parts;

    explicit Intersection(Bodies p) : parts(std::move(p)) {}

    double distance(const Vec3& x) const override
    {
        double farthest = -kInfinity;
        for (const BodyPointer& b : parts) farthest = std::max(farthest, b->distance(x));
        return farthest;
    }
    Vec3 normal(const Vec3& x) const override
    {
        const Body* active = parts.front().get();
        double farthest = active->distance(x);
        for (const BodyPointer& b : parts)
            if (const double d = b->distance(x); d > farthest) farthest = d, active = b.get();
        return active->normal(x);
    }
    Shape::Look over(std::span<const Vec3> corners, double enough) const override
    {
        Shape::Look look{-kInfinity, -kInfinity};
        for (const BodyPointer& b : parts) {
            const Shape::Look part = b->over(corners, enough);
            look = {std::max(look.least, part.least), std::max(look.middle, part.middle)};
        }
        return look;
    }
    double mostOver(std::span<const Vec3> corners) const override
    {
        double most = -kInfinity;
        for (const BodyPointer& b : parts) most = std::max(most, b->mostOver(corners));
        return most;
    }
    double steepest() const override { return steepestOf(parts); }
    Eigen::AlignedBox3d bounds(const Eigen::Isometry3d& t) const override
    {
        Eigen::AlignedBox3d common = unboundedBox();
        for (const BodyPointer& b : parts) common = common.intersection(b->bounds(t));
        return common.isEmpty() ? Eigen::AlignedBox3d() : common;
    }
    BodyPointer movedBody(const Eigen::Isometry3d& t) const override { return std::make_shared<Intersection>(moveAll(parts, t)); }
};

/// The outside of a body; of an outside, the body itself.
BodyPointer outsideOf(const BodyPointer& body)
{
    if (body && body->inner()) return *body->inner();
    return std::make_shared<Outside>(body);
}

}  // namespace

BodyPointer moveBody(const BodyPointer& body, const Eigen::Isometry3d& transform)
{
    BodyPointer moved = body->movedBody(transform);
    return moved ? moved : std::make_shared<Placed>(body, transform);
}

Shape Shape::inverted() const { return Shape(outsideOf(body_)); }

Shape Shape::unite(const std::vector<Shape>& shapes)
{
    Bodies parts = bodies(shapes);
    if (parts.empty()) return {};
    if (parts.size() == 1) return Shape(parts.front());
    return Shape(std::make_shared<Union>(std::move(parts)));
}

Shape Shape::intersect(const std::vector<Shape>& shapes)
{
    Bodies parts = bodies(shapes);
    if (parts.empty() || parts.size() < shapes.size()) return {};
    if (parts.size() == 1) return Shape(parts.front());
    return Shape(std::make_shared<Intersection>(std::move(parts)));
}

Shape Shape::subtract(const std::vector<Shape>& shapes)
{
    if (shapes.empty() || shapes.front().empty()) return {};
    Bodies parts = bodies(shapes);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        parts[i] = outsideOf(parts[i]);
        if (!parts[i]) return {};  // everything was taken away
    }
    if (parts.size() == 1) return Shape(parts.front());
    return Shape(std::make_shared<Intersection>(std::move(parts)));
}

}  // namespace sim
