#pragma once

#include "sim/core/types.h"
#include "sim/fabric/pieces/generators.h"

#include <span>

namespace app {

/// Points on a lattice: x = origin + column u + row v + height w.
struct LatticeFit {
    sim::Vec3 origin, u, v, w;  ///< w is 0 where all heights are [cm]
};

/// The lattice that is nearest to the points, in squares; heights may be empty.
LatticeFit fitLattice(std::span<const sim::Vec3> x, std::span<const sim::Vec2i> places, std::span<const double> heights);

/// The shortest decimal number that is the same but for rounding.
double shortest(double x);
sim::Vec3 shortest(const sim::Vec3& x);

/// The largest distance between points of the same number [cm].
double largestDistance(std::span<const sim::Vec3> a, std::span<const sim::Vec3> b);

}  // namespace app
