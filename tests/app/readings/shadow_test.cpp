#include "app/readings/shadow.h"
#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using sim::Vec3, sim::Vec3i;

/// A fan of triangles in the plane y = height.
void addDisc(const Vec3& center, double radius, int sides, std::vector<Vec3>& points, std::vector<Vec3i>& faces)
{
    const int first = static_cast<int>(points.size());
    points.push_back(center);
    for (int n = 0; n < sides; ++n) {
        const double angle = 2.0 * sim::kPi * n / sides;
        points.push_back(center + radius * Vec3(std::cos(angle), 0.0, std::sin(angle)));
        faces.emplace_back(first, first + 1 + n, first + 1 + (n + 1) % sides);
    }
}

TEST(Shadow, OfADiscIsItsArea)
{
    std::vector<Vec3> points;
    std::vector<Vec3i> faces;
    addDisc({3.0, 1.0, -2.0}, 15.0, 200, points, faces);
    EXPECT_NEAR(sim::kPi * 225.0, app::shadowArea(points, faces, 1), 1.0e-3 * sim::kPi * 225.0);
    EXPECT_NEAR(0.0, app::shadowArea(points, faces, 0), 1.0e-9);
}

TEST(Shadow, WhatLiesOneOverTheOtherCountsOnce)
{
    std::vector<Vec3> points;
    std::vector<Vec3i> faces;
    addDisc(Vec3::Zero(), 2.0, 100, points, faces);
    const double one = app::shadowArea(points, faces, 1);
    addDisc({0.5, 3.0, 0.0}, 1.0, 100, points, faces);
    EXPECT_NEAR(one, app::shadowArea(points, faces, 1), 1.0e-12 * one);
    addDisc({9.0, 0.0, 0.0}, 2.0, 100, points, faces);
    EXPECT_NEAR(2.0 * one, app::shadowArea(points, faces, 1), 1.0e-3 * one);
}

TEST(Shadow, OfNothingIsNone) { EXPECT_EQ(0.0, app::shadowArea({}, {}, 1)); }

}  // namespace
