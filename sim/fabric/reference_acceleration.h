#pragma once

#include "sim/core/parallel.h"
#include "sim/core/types.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sim {

/// Reference acceleration, to which errors of the fabric's motion are compared [cm/s^2]: gravity's; without gravity a fiftieth of what a step would
/// need to bring about the motion of its vertices against each other and the energy of its form, and no less than moves it by a millionth of
/// its thickness. It has no time or length of its own, so that similar scenes have similar results.
/// @param mass, velocity, radius  of each vertex [g, cm/s, cm]
/// @param elasticEnergy           gives that of the fabric [erg]; not asked where there is gravity
/// @param h                       length of the step [s]
template <class ElasticEnergy>
double referenceAcceleration(const Vec3& gravity, std::span<const double> mass, std::span<const Vec3> velocity, std::span<const double> radius,
                             ElasticEnergy&& elasticEnergy, double h)
{
    if (!gravity.isZero(0.0)) return gravity.norm();
    constexpr double kShare = 0.02, kLeastMove = 1.0e-6;
    const auto sum = [&](auto&& of) { return parallelSum(mass.size(), [&](std::size_t v) { return mass[v] * of(v); }); };
    const double total = sum([](std::size_t) { return 1.0; });
    Vec3 mean;
    for (int a = 0; a < 3; ++a) mean[a] = sum([&](std::size_t v) { return velocity[v][a]; }) / total;
    const double squaredSpeed = (sum([&](std::size_t v) { return (velocity[v] - mean).squaredNorm(); }) + 2.0 * elasticEnergy()) / total;
    const double thickness = sum([&](std::size_t v) { return radius[v]; }) / total;
    return std::max(kShare * std::sqrt(squaredSpeed) / h, kLeastMove * thickness / (h * h));
}

}  // namespace sim
