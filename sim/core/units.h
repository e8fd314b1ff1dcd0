#pragma once

// Everything inside is CGS: cm, g, s, dyn = g cm/s^2, pressure dyn/cm^2, viscosity P = g/(cm s),
// surface tension dyn/cm, angles in radians.

namespace sim {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kEarthGravity = 981.0;  ///< [cm/s^2]

}  // namespace sim
