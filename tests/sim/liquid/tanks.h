#pragma once

#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/Geometry>

// Tanks of liquid under gravity.

namespace sim::test {

inline constexpr double kDt = 1.0e-3, kGravity = 981.0;
inline const auto kAtRest = [](const Vec3&) { return Vec3(Vec3::Zero()); };
inline const auto kFalling = [](const Vec3&) { return Vec3(0.0, -kGravity * kDt, 0.0); };

/// A tank of 6 × 12 × 5 cells, filled to `level` cells above its floor.
inline GridScene column(double level, const Vec3i& shift = Vec3i::Zero())
{
    GridScene scene(Vec3i(-3, -3, -3) + shift, Vec3i(9, 15, 8) + shift);
    scene.add(tankOfCells(scene, shift, Vec3i(6, 12, 5) + shift));
    const double surface = scene.corner(shift).y() + level * scene.grid.dx;
    scene.fill([&](const Vec3& x) { return x.y() - surface; });
    scene.setVelocities(kFalling);
    return scene;
}

/// A tank of 24 cells edge turned about z by `angle`, not aligned with anything.
inline Shape turnedTank(const GridScene& scene, double angle, Vec3 half)
{
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.translate(scene.corner({10, 10, 10}) + scene.grid.dx * Vec3(0.13, 0.37, 0.21));
    place.rotate(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    return Shape::box(Vec3::Zero(), half * scene.grid.dx).inverted().moved(place);
}

}  // namespace sim::test
