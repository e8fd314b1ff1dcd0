#include "sim/core/units.h"
#include "sim/scene/load_scene.h"
#include "tests/sim/scene/liquid_scene.h"

#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

using sim::Scene;
using sim::Vec3;

using sim::test::kGrid, sim::test::kSmallest, sim::test::load;

sim::Shape shapeOf(const std::string& shape) { return load(kGrid + "liquid: {sources: [{shape: " + shape + "}]}\n").sources.at(0).shape; }

sim::Motion motionOf(const std::string& motion)
{
    return load(kSmallest + "obstacles: [{name: paddle, shape: {ball: {center: [9, 0, 0], radius: 1}}, motion: " + motion + "}]\n")
        .obstacles.at(0)
        .motion;
}

TEST(LoadScene, ShapesAreWhatTheySay)
{
    EXPECT_DOUBLE_EQ(-1.0, shapeOf("{box: {min: [0, 0, 0], max: [4, 2, 2]}}").distance(Vec3(2, 1, 1)));
    EXPECT_DOUBLE_EQ(1.0, shapeOf("{box: {center: [0, 0, 0], half: [1, 2, 3]}}").distance(Vec3(2, 0, 0)));
    EXPECT_NEAR(0.5, shapeOf("{rounded_box: {center: [0, 0, 0], half: [1, 1, 1], round: 0.5}}").distance(Vec3(2, 0, 0)), 1e-12);
    EXPECT_NEAR(0.5, shapeOf("{capsule: {a: [0, 0, 0], b: [4, 0, 0], radius: 0.5}}").distance(Vec3(5, 0, 0)), 1e-12);
    EXPECT_NEAR(0.5, shapeOf("{cylinder: {center: [0, 0, 0], axis: [0, 0, 3], radius: 1, half: 2}}").distance(Vec3(0, 0, 2.5)), 1e-12);
    EXPECT_NEAR(-0.5,
                shapeOf("{subtract: [{ball: {center: [0, 0, 0], radius: 2}}, {ball: {center: [2, 0, 0], radius: 1.5}}]}").distance(Vec3(0, 0, 0)),
                1e-12);
    EXPECT_DOUBLE_EQ(-1.0,
                     shapeOf("{union: [{ball: {center: [0, 0, 0], radius: 1}}, {ball: {center: [5, 0, 0], radius: 1}}]}").distance(Vec3(5, 0, 0)));
    EXPECT_DOUBLE_EQ(1.0, shapeOf("{intersect: [{box: {center: [0, 0, 0], half: [2, 2, 2]}}, {invert: {ball: {center: "
                                  "[0, 0, 0], radius: 1}}}]}")
                              .distance(Vec3(0, 0, 0)));
}

TEST(LoadScene, ShapesTurnAboutTheirMiddleThenMove)
{
    const sim::Shape bar = shapeOf(
        "{box: {min: [4, -0.5, -0.5], max: [8, 0.5, 0.5]}, rotate: {axis: [0, 0, 1], angle: 90}, translate: [0, 10, "
        "0]}");
    EXPECT_NEAR(-0.5, bar.distance(Vec3(6, 11, 0)), 1e-12);
    EXPECT_NEAR(1.5, bar.distance(Vec3(8, 10, 0)), 1e-12);
    const sim::Shape swung = shapeOf("{ball: {center: [4, 0, 0], radius: 1}, rotate: {axis: [0, 0, 1], angle: 90, origin: [0, 0, 0]}}");
    EXPECT_NEAR(-1.0, swung.distance(Vec3(0, 4, 0)), 1e-12);
}

TEST(LoadScene, MotionsAreWhatTheySay)
{
    const Vec3 start(9, 0, 0);
    EXPECT_NEAR(5.0, (motionOf("{t: [0, 2], translate: [0, 5, 0]}").transform(2.0) * start)[1], 1e-9);
    EXPECT_NEAR(9.0, (motionOf("{t: [0, 2], rotate: {axis: [0, 0, 2], angle: 90}}").transform(2.0) * start)[1], 1e-9);
    EXPECT_NEAR(0.5, (motionOf("{t: [0, 9], oscillate: {direction: [0, 1, 0], amplitude: 5 mm, frequency: 1}}").transform(0.25) * start)[1], 1e-9);
    EXPECT_NEAR(9.0, (motionOf("{t: [0, 9], oscillate: {axis: [0, 0, 1], amplitude: 90, frequency: 1}}").transform(0.25) * start)[1], 1e-9);
    EXPECT_NEAR(2.0, (motionOf("{keys: [[0, 0, 0, 0], [1, 0, 2, 0]], interp: linear}").transform(1.0) * start)[1], 1e-9);
    EXPECT_NEAR(3.0, (motionOf("[{t: [0, 1], translate: [0, 1, 0]}, {t: [1, 2], translate: [0, 2, 0]}]").transform(2.0) * start)[1], 1e-9);
    EXPECT_FALSE(motionOf("{t: [0, 2], translate: [0, 5, 0]}").isStatic());
}

TEST(LoadScene, MotionsMayStandApart)
{
    const std::string obstacle = "obstacles: [{name: paddle, shape: {ball: {center: [9, 0, 0], radius: 1}}}]\n";
    const Vec3 start(9, 0, 0);
    for (const char* motion : {"motion: [{obstacle: paddle, t: [0, 1], translate: [0, 1, 0]}, {group: paddle, t: [1, 2], translate: [0, 2, "
                               "0]}]\n",
                               "motion: {paddle: [{t: [0, 1], translate: [0, 1, 0]}, {t: [1, 2], translate: [0, 2, 0]}]}\n"}) {
        const Scene scene = load(kSmallest + obstacle + motion);
        EXPECT_NEAR(3.0, (scene.obstacles[0].motion.transform(2.0) * start)[1], 1e-9) << motion;
    }
}

TEST(LoadScene, SmallSourcesBetweenObstaclesAreNotCalledEmpty)
{
    const Scene scene = load(kGrid + R"(
liquid: {sources: [{shape: {box: {min: [-5, -5, -5], max: [5, 5, 5]}}}]}
obstacles:
  - {name: left, shape: {box: {min: [-9, -9, -9], max: [1.234, 9, 9]}}}
  - {name: right, shape: {box: {min: [1.235, -9, -9], max: [9, 9, 9]}}}
)");
    EXPECT_EQ(1u, scene.sources.size());
}

}  // namespace
