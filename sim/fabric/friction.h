#pragma once

#include "sim/core/types.h"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace sim {

/// Forces of friction that were held at the end of a step, by the numbers of the two that touch there: ascending, no two alike.
struct FrictionForces {
    std::vector<Vec2i> between;
    std::vector<Vec3> force;  ///< energy gradient by the position of the first against the second [dyn]

    void clear() { between.clear(), force.clear(); }
    void add(const Vec2i& pair, const Vec3& f) { between.push_back(pair), force.push_back(f); }
    static bool isBefore(const Vec2i& a, const Vec2i& b) { return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]); }
    /// 0 for what did not touch.
    Vec3 at(const Vec2i& pair) const
    {
        const auto found = std::ranges::lower_bound(between, pair, isBefore);
        return found != between.end() && *found == pair ? force[found - between.begin()] : Vec3::Zero().eval();
    }
};

}  // namespace sim
