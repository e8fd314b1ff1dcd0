#include "sim/liquid/extrapolate.h"

#include "tests/sim/liquid/grid_scene.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

void extrapolateAll(GridScene& scene)
{
    ExtrapolationScratch scratch;
    std::vector<int> blocks(scene.grid.count());
    std::iota(blocks.begin(), blocks.end(), 0);
    extrapolate(scene.grid, blocks, scratch, scene.liquid.faces.valid, scene.liquid.faces.velocity);
}

TEST(Extrapolation, CarriesAConstantAsItIs)
{
    GridScene scene({-8, -8, -8}, {16, 8, 8});
    std::mt19937 random(5);
    scene.forEachFace([&](int a, const Vec3i& c) {
        scene.velocity(a, c) = 1.0e9;
        if (random() % 40 != 0) return;
        scene.velocity(a, c) = 3.75 + a;
        scene.setValid(a, c);
    });
    extrapolateAll(scene);
    std::size_t reached = 0;
    scene.forEachFace([&](int a, const Vec3i& c) {
        if (!scene.isValid(a, c)) return;
        ++reached;
        EXPECT_NEAR(scene.velocity(a, c), 3.75 + a, 1.0e-14);
    });
    EXPECT_GT(reached, 10000u);
}

TEST(Extrapolation, ReachesThreeNeighboursAndNoFurther)
{
    for (int axis = 0; axis < kAxes; ++axis)
        for (const Vec3i& seed : {Vec3i(0, 0, 0), Vec3i(7, 7, 7), Vec3i(3, 0, 7), Vec3i(-1, 2, 4)}) {
            GridScene scene({-8, -8, -8}, {16, 16, 16});
            scene.velocity(axis, seed) = 2.0;
            scene.setValid(axis, seed);
            extrapolateAll(scene);
            scene.forEachFace([&](int a, const Vec3i& c) {
                const bool reached = a == axis && (c - seed).cwiseAbs().sum() <= kExtrapolationSweeps;
                ASSERT_EQ(scene.isValid(a, c), reached) << a << ": " << c.transpose() << " from " << seed.transpose();
                ASSERT_EQ(scene.velocity(a, c), reached ? 2.0 : 0.0);
            });
        }
}

TEST(Extrapolation, IsTheSameWhereverTheBlocksBegin)
{
    const auto build = [](const Vec3i& shift) {
        GridScene scene(Vec3i(-4, -4, -4) + shift, Vec3i(16, 14, 13) + shift);
        std::mt19937 random(7);
        for (int a = 0; a < kAxes; ++a)
            for (int n = 0; n < 60; ++n) {
                const Vec3i c(static_cast<int>(random() % 12), static_cast<int>(random() % 10),
                              static_cast<int>(random() % 9));
                scene.velocity(a, c + shift) = 1.0 + 0.01 * static_cast<double>(random() % 100);
                scene.setValid(a, c + shift);
            }
        extrapolateAll(scene);
        return scene;
    };
    GridScene scene = build(Vec3i::Zero());
    for (int n = 1; n < 8; ++n)
        for (const Vec3i& shift : {Vec3i(n, 0, 0), Vec3i(0, n, 0), Vec3i(0, 0, n), Vec3i(n, 8 - n, -n)}) {
            GridScene other = build(shift);
            for (int a = 0; a < kAxes; ++a)
                for (int z = -4; z < 13; ++z)
                    for (int y = -4; y < 14; ++y)
                        for (int x = -4; x < 16; ++x) {
                            const Vec3i c(x, y, z), to = c + shift;
                            ASSERT_EQ(scene.isValid(a, c), other.isValid(a, to))
                                << c.transpose() << " by " << shift.transpose();
                            if (!scene.isValid(a, c)) continue;
                            ASSERT_NEAR(scene.velocity(a, c), other.velocity(a, to), 1.0e-14);
                        }
        }
}

}  // namespace
}  // namespace sim::test
