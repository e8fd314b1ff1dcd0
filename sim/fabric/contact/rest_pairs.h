#pragma once

#include "sim/fabric/contact/primitives.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace sim::contact {

/// Pairs that are nearer at rest than they act: each has an offset of its own, so that the fabric at rest is free of forces.
struct RestPairs {
    std::vector<int> begin;        ///< first pair of each first primitive in the arrays below, and the end; empty as long as there are none
    std::vector<int> partner;      ///< ascending
    std::vector<double> distance;  ///< [cm]

    /// Infinite for a pair that is not among them [cm].
    double distanceOf(int a, int b) const
    {
        if (begin.empty()) return std::numeric_limits<double>::infinity();
        const auto first = partner.begin() + begin[a], last = partner.begin() + begin[a + 1];
        const auto found = std::lower_bound(first, last, b);
        return found != last && *found == b ? distance[found - partner.begin()] : std::numeric_limits<double>::infinity();
    }
};

}  // namespace sim::contact
