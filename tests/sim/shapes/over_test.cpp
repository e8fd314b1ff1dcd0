#include "sim/core/units.h"
#include "sim/shapes/shape.h"
#include "sim/shapes/tessellate.h"

#include <gtest/gtest.h>

#include <random>

namespace sim {
namespace {

class Numbers {
 public:
    explicit Numbers(unsigned seed) : generator_(seed) {}
    double operator()() { return uniform_(generator_); }
    Vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

 private:
    std::mt19937 generator_;
    std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

Eigen::Isometry3d anyMotion(Numbers& random)
{
    return Eigen::Translation3d(0.5 * random.vector()) * Eigen::AngleAxisd(kPi * random(), random.vector().normalized());
}

Shape anyPrimitive(Numbers& random)
{
    const Vec3 half = 0.6 * random.vector().cwiseAbs();
    const double round = 0.2 + 0.15 * random();
    switch (static_cast<int>(2.5 * (1.0 + random()))) {
        case 0: return Shape::box(random.vector(), half);
        case 1: return Shape::roundedBox(random.vector(), half, round);
        case 2: return Shape::ball(random.vector(), round);
        case 3: return Shape::capsule(random.vector(), random.vector(), round);
        default: return Shape::cylinder(random.vector(), random.vector().normalized(), 2.0 * round, half.x(), round);
    }
}

Shape anyShape(Numbers& random)
{
    const Shape a = anyPrimitive(random).moved(anyMotion(random)), b = anyPrimitive(random), c = anyPrimitive(random).moved(anyMotion(random));
    const double kind = random();
    if (kind < -0.6) return a;
    if (kind < -0.2) return Shape::unite({a, b, c}).moved(anyMotion(random));
    if (kind < 0.1) return Shape::intersect({a, b.inverted(), c});
    if (kind < 0.4) return Shape::subtract({a, b, c}).moved(anyMotion(random));
    if (kind < 0.7) return Shape::unite({a, b}).inverted();
    const TriangleMesh mesh = tessellate(Shape::unite({a, b}), 0.1);
    return Shape::mesh(mesh.vertices, mesh.triangles, 0.1).moved(anyMotion(random));
}

std::vector<Vec3> anyHull(Numbers& random)
{
    std::vector<Vec3> corners(1 + static_cast<std::size_t>(2.99 * (1.0 + random())));
    const Vec3 middle = 1.5 * random.vector();
    const double size = std::pow(10.0, -1.0 + random());
    for (Vec3& x : corners) x = middle + size * random.vector();
    return corners;
}

Vec3 anyPointOf(const std::vector<Vec3>& corners, Numbers& random)
{
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (const Vec3& x : corners) {
        const double w = -std::log(0.5 + 0.4999 * random());
        sum += w * x;
        weights += w;
    }
    return sum / weights;
}

TEST(ShapeOver, BoundsTheDistanceAllOverTheHull)
{
    for (unsigned seed = 1; seed <= 150; ++seed) {
        Numbers random(seed);
        const Shape shape = anyShape(random);
        if (shape.empty()) continue;
        for (int n = 0; n < 20; ++n) {
            const std::vector<Vec3> corners = anyHull(random);
            const Shape::Look look = shape.over(corners);
            EXPECT_LE(look.least, look.middle + 1.0e-12);
            for (int m = 0; m < 20; ++m) ASSERT_GE(shape.distance(anyPointOf(corners, random)), look.least - 1.0e-12) << "seed " << seed;
            for (const Vec3& x : corners) {
                ASSERT_GE(shape.distance(x), look.least - 1.0e-12) << "seed " << seed;
                EXPECT_NEAR(shape.over({&x, 1}).least, shape.distance(x), 1.0e-6) << "seed " << seed;  // samples of meshes are floats
            }
        }
    }
}

TEST(ShapeOver, BoundsAsWellAsItIsAskedTo)
{
    for (unsigned seed = 1; seed <= 150; ++seed) {
        Numbers random(seed);
        const Shape shape = anyShape(random);
        if (shape.empty()) continue;
        for (int n = 0; n < 20; ++n) {
            const std::vector<Vec3> corners = anyHull(random);
            const Shape::Look best = shape.over(corners);
            for (const double enough : {best.least - 0.3, best.least - 1.0e-3, best.least + 1.0e-3}) {
                const Shape::Look look = shape.over(corners, enough);
                EXPECT_LE(look.least, best.least + 1.0e-12) << "seed " << seed;
                EXPECT_GE(look.least, std::min(enough, best.least) - 1.0e-12) << "seed " << seed;
                EXPECT_EQ(look.middle, best.middle) << "seed " << seed;
            }
        }
    }
}

/// A hull on or along a flat surface is seen as it is, and inside of what is convex.
TEST(ShapeOver, IsExactAtPlanesAndInsideConvexWalls)
{
    Numbers random(7);
    for (int n = 0; n < 200; ++n) {
        const Eigen::Isometry3d motion = anyMotion(random);
        const Shape box = Shape::box(Vec3::Zero(), Vec3(10.0, 0.01, 10.0)).moved(motion), room = Shape::ball(Vec3::Zero(), 8.0).inverted();
        std::vector<Vec3> corners = anyHull(random);
        double lowest = 1.0e9, nearest = 1.0e9;
        for (Vec3& x : corners) {
            x.y() = 0.02 + std::abs(x.y());
            lowest = std::min(lowest, x.y() - 0.01);
            x = motion * x;
            nearest = std::min(nearest, 8.0 - x.norm());
        }
        EXPECT_NEAR(box.over(corners).least, lowest, 1.0e-12);
        EXPECT_NEAR(room.over(corners).least, nearest, 1.0e-12);
    }
}

}  // namespace
}  // namespace sim
