#pragma once

#include "sim/fabric/safe_moves.h"

namespace sim::contact {

// Distances of a pair at which something happens, relative to others (fabric/contact/README.md, Pairs). That nothing ever crosses rests on the search
// for pairs, whose margins follow from them.

inline constexpr double kBand = 0.25;           ///< distance over which a pair acts before it touches, of the thinner one's radius [-]
inline constexpr double kCore = kCoreDistance;  ///< nearest that a pair ever comes, of the sum of its radii [-]
inline constexpr double kCoreAtRest = 0.65;     ///< nearest that it comes, of its distance at rest, where that is less [-]
inline constexpr double kWall = 0.3;            ///< part of the way from the core to the reach below which the spring becomes a wall [-]
inline constexpr double kFloor = 0.15;          ///< part of that way below which no move may take a pair unseen [-]

/// Largest reach and floor of any pair, of the sum of its radii [-].
inline constexpr double kMostReach = 1.0 + 0.5 * kBand, kMostFloor = kCore + kFloor * (kMostReach - kCore);

static_assert(0.0 < kCore && kCore < 1.0 && 0.0 < kCoreAtRest && kCoreAtRest < 1.0, "pairs that touch may be pressed, pairs at rest as well");
static_assert(0.0 < kFloor && kFloor < kWall && kWall < 1.0, "moves are looked at before the wall is passed");

/// Distance below which moves are looked at closely [cm].
template <class T>
constexpr T floorOf(T reach, T core)
{
    return core + kFloor * (reach - core);
}

}  // namespace sim::contact
