#pragma once

#include "sim/fabric/triple.h"

namespace sim {

/// P(from → to) v: the least rotation that takes one unit vector to the other. Singular only where `to` = −`from`.
template <class T>
Triple<T> transported(const Triple<T>& v, const Triple<T>& from, const Triple<T>& to)
{
    const T c = dot(from, to);
    const T least = constant<T>(1.0e-12);
    const Triple<T> b = cross(from, to);
    return c * v + cross(b, v) + (dot(b, v) / largerOf(constant<T>(1.0) + c, least)) * b;
}

/// The part of v across the unit vector t, at length 1.
template <class T>
Triple<T> unitAcross(const Triple<T>& v, const Triple<T>& t)
{
    const Triple<T> across = v - dot(v, t) * t;
    return (constant<T>(1.0) / norm(across)) * across;
}

}  // namespace sim
