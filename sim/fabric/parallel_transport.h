#pragma once

#include "sim/fabric/vec3t.h"

namespace sim {

/// P(from → to) v: the least rotation that takes one unit vector to the other. Singular only where `to` = −`from`.
template <class T>
Vec3T<T> transported(const Vec3T<T>& v, const Vec3T<T>& from, const Vec3T<T>& to)
{
    const T c = dot(from, to);
    const T least = constant<T>(1.0e-12);
    const Vec3T<T> b = cross(from, to);
    return c * v + cross(b, v) + (dot(b, v) / largerOf(constant<T>(1.0) + c, least)) * b;
}

/// The part of v across the unit vector t, at length 1.
template <class T>
Vec3T<T> unitAcross(const Vec3T<T>& v, const Vec3T<T>& t)
{
    const Vec3T<T> across = v - dot(v, t) * t;
    return (constant<T>(1.0) / norm(across)) * across;
}

}  // namespace sim
