#include "sim/liquid/walls.h"

#include "sim/core/units.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// Faces that are open get u and are valid, all others nothing; then what the step does.
template <class U>
void fillAndApply(GridScene& scene, double friction, U&& u)
{
    scene.setVelocities([](const Vec3&) { return Vec3(Vec3::Constant(1.0e6)); });
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (scene.open(a, c) == 0.0) return;
        scene.velocity(a, c) = u(scene.faceMiddle(a, c))[a];
        scene.setValid(a, c);
    });
    scene.forEachFace(
        [&](int a, const Vec3i& c) { scene.liquid.faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell] = 1.0; });
    WallFaces followers;
    followers.find(scene.cut(), friction, scene.liquid.faces);
    applyWalls(scene.cut(), friction, false, followers, scene.liquid.faces.valid, scene.liquid.faces.velocity);
}

TEST(Walls, FreeSlipMirrorsTheLiquidAlsoInEdgesAndCorners)
{
    for (const Vec3i& size : {Vec3i(8, 8, 8), Vec3i(5, 11, 4), Vec3i(10, 4, 6)}) {
        GridScene scene({-3, -3, -3}, size + Vec3i::Constant(4));
        scene.add(tankOfCells(scene, {0, 0, 0}, size));
        const Vec3 low = scene.corner({0, 0, 0}), k = kPi * (size.cast<double>() * scene.grid.dx).cwiseInverse();
        // Normal components odd, tangential ones even about every wall.
        const auto mirrored = [&](const Vec3& x) {
            const Vec3 q = (x - low).cwiseProduct(k), s = q.array().sin(), c = q.array().cos();
            return Vec3(s.x() * (1.0 + c.y()) * (2.0 + c.z()), s.y() * (1.5 + c.z()) * (1.0 + c.x()), s.z() * c.x() * c.y());
        };
        fillAndApply(scene, 0.0, mirrored);
        scene.forEachFace([&](int a, const Vec3i& c) {
            bool near = true;
            for (int axis = 0; axis < kAxes; ++axis) {
                const int end = axis == a ? size[axis] + 1 : size[axis];
                near = near && c[axis] >= -2 && c[axis] < end + 2;
            }
            if (!near) return;
            ASSERT_TRUE(scene.isValid(a, c)) << a << ": " << c.transpose();
            ASSERT_NEAR(scene.velocity(a, c), mirrored(scene.faceMiddle(a, c))[a], 1.0e-12) << a << ": " << c.transpose();
        });
    }
}

TEST(Walls, UniformFlowGoesOnBehindSkewWalls)
{
    const Vec3 flow(3.0, -2.0, 5.0);
    for (double friction : {0.0, 0.3}) {
        GridScene scene({-8, -8, -8}, {24, 24, 24});
        scene.add(skewTank(scene));
        fillAndApply(scene, friction, [&](const Vec3&) { return flow; });
        std::size_t closed = 0;
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (!scene.isValid(a, c)) return;
            const bool open = scene.open(a, c) > 0.0;
            closed += !open;
            const double expected = open ? flow[a] : (1.0 - friction) * flow[a];
            ASSERT_NEAR(scene.velocity(a, c), expected, 1.0e-12) << a << ": " << c.transpose();
        });
        EXPECT_GT(closed, 2000u);
    }
}

TEST(Walls, LiquidSticksToWallsOfFrictionOne)
{
    GridScene scene({-8, -8, -8}, {24, 24, 24});
    scene.add(skewTank(scene));
    fillAndApply(scene, 1.0, [](const Vec3&) { return Vec3(3.0, -2.0, 5.0); });
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (scene.open(a, c) > 0.0) return;
        ASSERT_EQ(scene.velocity(a, c), 0.0);
    });
}

TEST(Walls, SlipIsRelativeToAMovingWall)
{
    const Vec3 flow(3.0, -2.0, 5.0), wall(7.0, 4.0, -1.0);
    for (double friction : {0.0, 0.25, 1.0}) {
        GridScene scene({-8, -8, -8}, {24, 24, 24});
        Motion motion;
        motion.addTranslation(0.0, 1.0, wall, 0.0, 0.0);
        scene.obstacles.add(Shape::ball(scene.corner({8, 8, 8}), 5.2 * scene.grid.dx), motion);
        scene.obstacles.moveTo(0.25, 0.26);
        scene.updateObstacles();
        fillAndApply(scene, friction, [&](const Vec3&) { return flow; });
        scene.forEachFace([&](int a, const Vec3i& c) {
            if (!scene.isValid(a, c) || scene.open(a, c) > 0.0) return;
            const Vec3 n = scene.obstacles.normal(scene.faceMiddle(a, c)), relative = flow - wall;
            const double along = std::abs(n[a]) > 1.0 - 1.0e-6 ? 0.0 : relative[a];  // straight at a wall along the grid
            ASSERT_NEAR(scene.velocity(a, c), wall[a] + (1.0 - friction) * along, 1.0e-11);
        });
    }
}

TEST(Walls, FrictionOfAPlaneWallSlowsTheTangentialPartBehindIt)
{
    GridScene scene({-3, -3, -3}, {12, 12, 12});
    scene.add(tankOfCells(scene, {0, 0, 0}, {8, 8, 8}));
    fillAndApply(scene, 0.3, [](const Vec3&) { return Vec3(2.0, 0.0, 4.0); });
    EXPECT_NEAR(scene.velocity(0, {4, -1, 4}), 0.7 * 2.0, 1.0e-12);
    EXPECT_NEAR(scene.velocity(2, {4, -2, 4}), 0.7 * 4.0, 1.0e-12);
    EXPECT_EQ(scene.velocity(1, {4, 0, 4}), 0.0);
    EXPECT_NEAR(scene.velocity(2, {8, 4, 4}), 0.7 * 4.0, 1.0e-12);
}

}  // namespace
}  // namespace sim::test
