// Weight of faces next to plane walls (liquid/README.md, Walls).
#include "sim/core/units.h"
#include "sim/liquid/face_velocity.h"
#include "sim/liquid/walls.h"
#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace sim::test {
namespace {

/// Deep faces next to a wall.
struct AtWall {
    double low = 1.0e9, high = -1.0e9;  ///< velocities after levelling [cm/s]
    double moved = 0.0, weight = 0.0;   ///< sums of momenta: by levelling, and before it [g cm/s]

    void add(double mass, double before, double now)
    {
        low = std::min(low, now);
        high = std::max(high, now);
        moved += mass * (now - before);
        weight += mass * std::abs(before);
    }
};

/// Whatever particles brought, and whatever stands on the floor, deep faces next to a wall get the same velocity from weight, in sum what they had; all
/// that are not deep keep what their own images leave them.
TEST(ImageWeight, OfDeepFacesIsThatOfEvenLiquid)
{
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        GridScene scene({-3, -3, -3}, {16, 16, 16});
        const Vec3i size(7 + static_cast<int>(seed % 4), 6, 9);
        const Vec3 middle = 0.5 * (scene.corner({0, 0, 0}) + scene.corner(size));
        scene.add(Shape::box(middle, 0.5 * scene.grid.dx * size.cast<double>()).inverted());
        if (seed % 3 != 0) scene.add(Shape::ball(scene.corner({3, 0, 4}), scene.grid.dx * (1.5 + unit(random))));
        const Vec3 gravity(seed % 2 == 0 ? 300.0 * unit(random) : 0.0, -kEarthGravity, 0.0);
        scene.forEachFace([&](int a, const Vec3i& c) {
            if ((c.array() < -1).any() || (c.array() > size.array() + Vec3i::Unit(a).array()).any()) return;
            scene.liquid.faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell] = std::pow(10.0, 2.0 * unit(random));
        });
        scene.forEachCell([&](const Vec3i& c) {
            if ((c.array() >= 0).all() && (c.array() < size.array()).all() && unit(random) < 0.8)
                scene.liquid.deep.set(scene.at(c).block, scene.at(c).cell);
        });
        WallFaces followers;
        mirrorAtWalls(scene.grid, scene.obstacles, 0.0, scene.field, followers, scene.liquid);
        constexpr double kStep = 0.01;  // [s]
        computeFaceVelocities(scene.grid, gravity, kStep, false, scene.liquid);
        withholdWeightOfImages(scene.field, gravity, kStep, scene.liquid);
        const BlockArray<double, 3> before = scene.liquid.faces.velocity;
        levelWeightOfImages(scene.cut(), nullptr, kStep * gravity, scene.liquid);
        const auto mass = [&](int a, const Vec3i& c) {
            return scene.liquid.faces.sums.block(scene.at(c).block, FaceFields::kMass + a)[scene.at(c).cell];
        };
        std::map<std::pair<int, int>, AtWall> walls;  // by axis and cell
        int deepAtWalls = 0;
        scene.forEachFace([&](int a, const Vec3i& c) {
            if ((c.array() < 0).any() || c[a] < 1 || (c.array() >= size.array()).any() || !(mass(a, c) > 0.0)) return;
            const auto isDeep = [&](const Vec3i& cell) { return scene.liquid.deep.test(scene.at(cell).block, scene.at(cell).cell); };
            const bool isBetween = isDeep(c) && isDeep(c - Vec3i::Unit(a)), isAtWall = c[a] == 1 || c[a] == size[a] - 1;
            const double own = before.block(scene.at(c).block, a)[scene.at(c).cell], now = scene.velocity(a, c);
            if (isBetween && isAtWall) {
                walls[{a, c[a]}].add(mass(a, c), own, now);
                ++deepAtWalls;
            } else EXPECT_NEAR(now, isBetween ? kStep * gravity[a] : own, 1.0e-12) << seed << ", axis " << a << ", face " << c.transpose();
        });
        for (const auto& [place, wall] : walls) {
            EXPECT_LT(wall.high - wall.low, 1.0e-12) << seed << ", axis " << place.first << ", cell " << place.second;
            EXPECT_NEAR(wall.moved, 0.0, 1.0e-12 * wall.weight) << seed << ", axis " << place.first << ", cell " << place.second;
        }
        EXPECT_GT(deepAtWalls, 50);
    }
}

}  // namespace
}  // namespace sim::test
