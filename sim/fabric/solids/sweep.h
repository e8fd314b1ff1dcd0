#pragma once

#include "sim/shapes/shape.h"

#include <array>
#include <span>

namespace sim::solids {

/// A vertex, an edge or a face of fabric on its way past a solid, both in the frame in which the solid rests: each corner goes straight.
struct SweptElement {
    int corners = 0;               ///< 1, 2 or 3
    std::array<Vec3, 3> from, to;  ///< [cm]

    Vec3 at(const Vec3& weights, double part) const;
};

/// How near an element is to a solid.
struct Nearest {
    double least;    ///< lower bound: no point of the element is nearer [cm]
    double reached;  ///< distance of the nearest point found: least ≥ (1 − kNearestError) reached, unless the search was cut short [cm]
    Vec3 weights;    ///< weights of the corners at that point [-]
};
inline constexpr double kNearestError = 0.1;

/// @param enough  what is further away than this need not be known any closer [cm]; nor how deep is what reaches into the solid
Nearest nearestTo(const Shape& solid, std::span<const Vec3> corners, double enough);

/// How far an element may go without coming nearer to the solid than `separation` [cm].
struct SafePart {
    double part;   ///< part of its way that is safe [0..1]
    Vec3 weights;  ///< weights of the corners at the point that would come too near, if part < 1 [-]
};
/// Whatever the solid's shape and the length of the way: bounds of the distance over all that the element sweeps in a part of the
/// way, which is halved where they do not suffice.
SafePart safePart(const Shape& solid, const SweptElement& element, double separation);

}  // namespace sim::solids
