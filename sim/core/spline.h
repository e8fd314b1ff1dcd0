#pragma once

namespace sim {

/// Weights of the quadratic B-spline at the three nodes around a point: w[n] for the node n − 1 cells from the middle one.
/// @param r  point − middle node, in [−1/2, 1/2] [cells]
template <class T, class Weights>
[[gnu::always_inline]] constexpr void splineWeights(T r, Weights& w)
{
    w[0] = 0.5 * (0.5 - r) * (0.5 - r);
    w[1] = 0.75 - r * r;
    w[2] = 0.5 * (0.5 + r) * (0.5 + r);
}

}  // namespace sim
