#pragma once

#include "sim/grid/obstacles.h"

namespace sim {

/// Where solids touch or overlap, that nearest to a place within them may end at another, and its surface is none of what they make together.
/// The place on the surface of all together that is nearest to x, as far as it is found within `reach` [cm] in 26 directions and the normals
/// that they lead to; nothing if there is none, or x is outside.
std::optional<Vec3> nearestSurface(const Obstacles& obstacles, const Vec3& x, double reach);

/// Distance from the surface of all solids together, negative inside: as Obstacles::distance, but, where that is to a seam, to their common
/// surface, or −reach if none is so near [cm].
double distanceAcrossSeams(const Obstacles& obstacles, const Vec3& x, double reach);

/// Distance across seams, and the unit normal where it ends, away from the solids.
struct NearSurface {
    double distance;
    Vec3 normal;
};
NearSurface surfaceAcrossSeams(const Obstacles& obstacles, const Vec3& x, double reach);

}  // namespace sim
