#include "app/drawing/obstacle_meshes.h"

#include <gtest/gtest.h>

namespace app {
namespace {

/// A box that turns about an axis beside it while it goes along x, and one that stands still.
sim::Scene twoBoxes()
{
    sim::Scene scene;
    scene.settings.cell = 0.5;
    scene.obstacles.resize(2);
    scene.obstacles[0].name = "paddle";
    scene.obstacles[0].shape = sim::Shape::box({1, 2, 3}, {1, 0.5, 0.25});
    scene.obstacles[0].motion.addRotation(0.0, 2.0, {sim::Vec3(1, 2, 2) / 3.0, {4, 0, 0}}, 5.0, 0.0, 0.0);
    scene.obstacles[0].motion.addTranslation(0.0, 2.0, {6, 0, 0}, 0.5, 0.5);
    scene.obstacles[1].shape = sim::Shape::box({0, 0, 0}, {1, 1, 1});
    return scene;
}

TEST(MovingObstacle, HasTheVelocitiesOfItsPoints)
{
    const PlaceObstacles place = meshObstacles(twoBoxes());
    std::vector<FrameSnapshot::Mesh> before, now, after;
    constexpr double kTime = 0.8, kStep = 0.01;
    place(kTime - kStep, before);
    place(kTime, now);
    place(kTime + kStep, after);
    EXPECT_EQ(now[0].name, "paddle");
    ASSERT_EQ(now[0].velocities.size(), now[0].positions.size());
    float fastest = 0.0f;
    for (std::size_t i = 0; i < now[0].positions.size(); ++i) {
        const Eigen::Vector3f difference = (after[0].positions[i] - before[0].positions[i]) / static_cast<float>(2.0 * kStep);
        EXPECT_NEAR((now[0].velocities[i] - difference).norm(), 0.0f, 5e-3f) << "central differences";
        fastest = std::max(fastest, difference.norm());
    }
    EXPECT_GT(fastest, 5.0f);
    EXPECT_TRUE(now[1].velocities.empty());
}

}  // namespace
}  // namespace app
