#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace sim {

using Vec3 = Eigen::Vector3d;
using Vec2i = Eigen::Vector2i;
using Vec3i = Eigen::Vector3i;
using Mat3 = Eigen::Matrix3d;

/// The three axes, and with them the three face grids, are plain numbers 0 = x, 1 = y, 2 = z.
inline constexpr int kAxes = 3;

}  // namespace sim
