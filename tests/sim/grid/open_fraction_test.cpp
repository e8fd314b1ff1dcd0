#include "sim/grid/open_faces.h"

#include <gtest/gtest.h>

#include <random>

namespace sim::test {
namespace {

/// Of a surface that is plane along each edge.
double openFraction(double d00, double d10, double d11, double d01)
{
    const std::array<double, 4> d = {d00, d10, d11, d01};
    std::array<double, 4> crossing{};
    for (int n = 0; n < 4; ++n)
        if (const double next = d[(n + 1) % 4]; (d[n] < 0.0) != (next < 0.0)) crossing[n] = d[n] / (d[n] - next);
    return sim::openFraction(d, crossing);
}

/// Part of the unit square where a + b x + c y > 0: strips along y, of which each is exact.
double openAreaOfPlane(double a, double b, double c)
{
    constexpr int kStrips = 4000;
    double area = 0.0;
    for (int n = 0; n < kStrips; ++n) {
        const double atBottom = a + b * (n + 0.5) / kStrips, atTop = atBottom + c;
        if (atBottom >= 0.0 && atTop >= 0.0) area += 1.0;
        else if (atBottom >= 0.0 || atTop >= 0.0) area += std::max(atBottom, atTop) / std::abs(c);
    }
    return area / kStrips;
}

TEST(OpenFraction, OfAPlaneIsItsArea)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 2000; ++n) {
        const double b = unit(random), c = unit(random), a = 0.7 * unit(random) - 0.5 * (b + c);
        EXPECT_NEAR(openFraction(a, a + b, a + b + c, a + c), openAreaOfPlane(a, b, c), 2.0e-4) << a << ' ' << b << ' ' << c;
    }
}

TEST(OpenFraction, OfTheComplementIsTheRest)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int n = 0; n < 2000; ++n) {
        const double d[4] = {unit(random), unit(random), unit(random), unit(random)};
        const double open = openFraction(d[0], d[1], d[2], d[3]);
        EXPECT_GE(open, 0.0);
        EXPECT_LE(open, 1.0);
        EXPECT_NEAR(open + openFraction(-d[0], -d[1], -d[2], -d[3]), 1.0, 1.0e-14);
        EXPECT_NEAR(open, openFraction(d[1], d[2], d[3], d[0]), 1.0e-14) << "turned by a quarter";
        EXPECT_NEAR(open, openFraction(d[3], d[2], d[1], d[0]), 1.0e-14) << "gone round the other way";
    }
}

TEST(OpenFraction, IsNothingInsideAndEverythingOutside)
{
    EXPECT_EQ(openFraction(-1.0, -2.0, -0.1, -1.0e-12), 0.0);
    EXPECT_EQ(openFraction(1.0, 2.0, 0.1, 1.0e-12), 1.0);
    // Corners on the surface: a face in a wall, one along a wall, one along the edge of a tank, one in the edge of a
    // block.
    EXPECT_EQ(openFraction(0.0, 0.0, 0.0, 0.0), 0.0);
    EXPECT_EQ(openFraction(0.0, 0.0, 1.0, 1.0), 1.0);
    EXPECT_EQ(openFraction(0.0, 0.0, 1.0, 0.0), 1.0);
    EXPECT_EQ(openFraction(0.0, 0.0, -1.0, 0.0), 0.0);
    EXPECT_EQ(openFraction(0.0, 1.0, 0.0, -1.0), 0.5);
    // Two opposite corners of ±1: a quarter of a cut corner each, open or solid in the middle by the mean.
    EXPECT_DOUBLE_EQ(openFraction(-1.0, 3.0, -1.0, 3.0), 1.0 - 2.0 * 0.5 * 0.25 * 0.25);
    EXPECT_DOUBLE_EQ(openFraction(-3.0, 1.0, -3.0, 1.0), 2.0 * 0.5 * 0.25 * 0.25);
}

}  // namespace
}  // namespace sim::test
