#pragma once

#include "sim/core/types.h"

#include <Eigen/Core>

#include <algorithm>
#include <vector>

namespace sim {

using Vec2i = Eigen::Vector2i;

// Friction that sticks (Coulomb's, elastic up to its bound). What touches is held by a spring across the normal, whose force is
// remembered from step to step (Grips), carried along by what it holds on to, and never more than friction can hold: below that it
// comes to where it balances the load and nothing moves, above it slides at the bound. As springs against penetration do, its stiffness
// goes by mass/h², so that it neither knows a speed or a length of its own nor rings. Changes of h leave the force as it is. It gives
// back no more than the bound's square over twice its stiffness, a small part of what gravity does in a step, and where contact ends
// nothing. Source: Simo and Hughes 1998, "Computational Inelasticity" (return mapping).

/// Forces of friction that were held at the end of a step, by the numbers of the two that touch there: ascending, no two alike.
struct Grips {
    std::vector<Vec2i> between;
    std::vector<Vec3> force;  ///< its gradient: by the position of the first against the second [dyn]

    void clear() { between.clear(), force.clear(); }
    void add(const Vec2i& pair, const Vec3& f) { between.push_back(pair), force.push_back(f); }
    /// 0 for what did not touch.
    Vec3 at(const Vec2i& pair) const
    {
        const auto before = [](const Vec2i& a, const Vec2i& b) { return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]); };
        const auto found = std::ranges::lower_bound(between, pair, before);
        return found != between.end() && *found == pair ? force[found - between.begin()] : Vec3::Zero().eval();
    }
};

/// Share of a spring's force and stiffness that friction holds [0..1].
/// @param trial  its force if it held all [dyn]
/// @param bound  the most that friction holds: its coefficient times the normal force [dyn]
inline double heldShare(double trial, double bound) { return trial > bound ? bound / trial : 1.0; }

/// The same of a mass m where its slip at the end of the step is not known, but what it would be without friction. With κ = k h²/m and E
/// the spring's force at that slip the mass sticks up to E = (1 + κ) bound; sliding, it comes to where the spring would have E − κ bound.
/// @param trial      E [dyn]
/// @param stiffness  κ [-]
inline double expectedShare(double trial, double bound, double stiffness)
{
    return trial > (1.0 + stiffness) * bound ? bound / (trial - stiffness * bound) : 1.0;
}

}  // namespace sim
