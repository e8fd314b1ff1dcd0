#pragma once

#include "sim/core/check.h"
#include "sim/core/random.h"
#include "sim/core/units.h"
#include "sim/particles/point_bins.h"
#include "sim/shapes/volume.h"
#include "sim/sources/seed.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <set>

// Sources to fill.

namespace sim {

using Pattern = FillSettings::Pattern;

inline SeedPlan planOf(const Shape& source, Pattern pattern, double spacing = 0.0, std::uint64_t seed = 1)
{
    SeedPlan plan;
    plan.source = source;
    plan.fill = {pattern, seed, spacing};
    plan.dx = 0.288;
    return plan;
}

inline SeedPlan damBreak(Pattern pattern)
{
    const Shape tank = Shape::roundedBox({-7.2, 14.4, 0.72}, {14.4, 14.4, 0.72}, 0.72);
    SeedPlan plan = planOf(Shape::intersect({tank, Shape::box({13.92, 0.0, 0.72}, {15.84, 15.84, 1.44})}), pattern);
    plan.solids = {tank.inverted()};
    return plan;
}

inline double countOf(const Seeds& seeds) { return static_cast<double>(seeds.positions.size()); }

inline const Pattern kPatterns[] = {Pattern::Lattice, Pattern::Reference, Pattern::Jittered, Pattern::Poisson};

inline Eigen::Isometry3d turned(double angle, const Vec3& axis, const Vec3& to)
{
    return Eigen::Isometry3d(Eigen::Translation3d(to) * Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace sim
