#pragma once

#include "sim/core/types.h"

#include <algorithm>
#include <cmath>

namespace sim {

/// How far a vertex did not go along each axis in the last step where its loads would have taken it, because the fabric's own forces held it:
/// 0 of what is free or swings, 1 of taut cloth that carries water. Along d, the direction of these forces, all of the acceleration n is
/// 1 - h of what it is without them; the diagonal of h d d^T [0..1].
/// @param own, all  accelerations by the fabric's own forces, and by all [cm/s^2]
inline Vec3 heldShare(const Vec3& own, const Vec3& all)
{
    const double size = own.norm();
    if (!(size > 0.0)) return Vec3::Zero();
    const Vec3 along = own / size;
    const double got = std::abs(all.dot(along)), without = std::abs(all.dot(along) - size);
    return (without > got ? 1.0 - got / without : 0.0) * along.cwiseAbs2();
}

}  // namespace sim
