#pragma once

namespace sim {

// What holds for moves among fabric and past solids alike.

inline constexpr double kCoreDistance = 0.57;  ///< nearest that fabric comes to fabric, of the sum of both radii, and to a solid, of its radius [-]
inline constexpr double kSafeShare = 0.95;     ///< share that is made of the longest part of all moves that is safe [-]

}  // namespace sim
