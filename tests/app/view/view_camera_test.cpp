#include "app/view/view_camera.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using Eigen::Vector3d;

render::Camera start() { return {.eye = {0.0, 0.0, 10.0}, .target = {0.0, 0.0, 0.0}, .up = Vector3d::UnitY(), .fovDegrees = 60.0}; }

TEST(ViewCamera, OrbitsAtTheSameDistance)
{
    ViewCamera view(start());
    view.orbit(0.5, 0.0);  // a quarter turn: the scene follows the pointer to the right, so the eye goes to the left
    EXPECT_LT((view.camera().eye - Vector3d(-10.0, 0.0, 0.0)).norm(), 1.0e-12);
    view.orbit(-0.5, -0.25);  // back, and down by an eighth: from above
    EXPECT_LT((view.camera().eye - 10.0 * Vector3d(0.0, std::sqrt(0.5), std::sqrt(0.5))).norm(), 1.0e-12);
    EXPECT_EQ(view.camera().target, Vector3d::Zero());
}

TEST(ViewCamera, NeverReachesThePoles)
{
    ViewCamera view(start());
    for (int n = 0; n < 10; ++n) view.orbit(0.1, -1.0);
    const Vector3d side = (view.camera().target - view.camera().eye).normalized();
    EXPECT_LT(std::abs(side.dot(Vector3d::UnitY())), 1.0);
    EXPECT_GT(view.camera().eye.y(), 9.9);
    EXPECT_NEAR(view.camera().eye.norm(), 10.0, 1.0e-9);
}

TEST(ViewCamera, PansWithThePointer)
{
    ViewCamera view(start());
    view.pan(1.0, 0.0);  // by the picture's height: 2 · 10 cm · tan 30°
    EXPECT_NEAR(view.camera().target.x(), -20.0 * std::tan(3.14159265358979 / 6.0), 1.0e-9);
    EXPECT_LT((view.camera().eye - view.camera().target - Vector3d(0.0, 0.0, 10.0)).norm(), 1.0e-12);
}

TEST(ViewCamera, ZoomsByTheSameFactorInAndOut)
{
    ViewCamera view(start());
    view.zoom(3.0);
    EXPECT_NEAR(view.camera().eye.z(), 10.0 * 0.9 * 0.9 * 0.9, 1.0e-12);
    view.zoom(-3.0);
    EXPECT_NEAR(view.camera().eye.z(), 10.0, 1.0e-12);
}

TEST(ViewCamera, FramesWhatThereIsFromItsSide)
{
    ViewCamera view(start());
    view.orbit(0.5, 0.0);
    view.frame({Vector3d(5.0, 5.0, 5.0), Vector3d(7.0, 6.0, 9.0)}, 1.5);
    const Vector3d ahead = (view.camera().target - view.camera().eye).normalized();
    EXPECT_LT((ahead - Vector3d::UnitX()).norm(), 0.2);
    EXPECT_LT((view.camera().target - Vector3d(6.0, 5.5, 7.0)).norm(), 2.0);
}

}  // namespace
}  // namespace app
