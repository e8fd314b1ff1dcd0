#include "render/camera.h"

#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

using namespace render;
using Eigen::Vector3d;

const Eigen::AlignedBox3d kTank(Vector3d(-22.32, -0.72, -0.72), Vector3d(7.92, 29.52, 2.16));

/// The largest |x| or |y| in clip space over the box's corners: at most 1 if all are in the picture.
double reachInPicture(const Eigen::AlignedBox3d& box, const Camera& camera, double aspect)
{
    double reach = 0.0;
    for (int i = 0; i < 8; ++i) {
        const Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
        const Vector3d eye = viewTransform(camera) * corner;
        EXPECT_LT(eye.z(), 0.0) << "behind the camera";
        const Eigen::Vector4d clip = projection(camera, aspect, 0.1, 1000.0) * eye.homogeneous();
        reach = std::max({reach, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
    }
    return reach;
}

TEST(Camera, FramesContainTheBoxFromEverySide)
{
    for (const double aspect : {16.0 / 9.0, 1.0, 0.5})
        for (const double azimuth : {0.0, 30.0, 100.0, 250.0})
            for (const double elevation : {-60.0, 0.0, 20.0, 85.0}) {
                const Camera from = orbitCamera(Vector3d::Zero(), 1.0, azimuth, elevation, 35.0);
                EXPECT_LE(reachInPicture(kTank, frameBall(kTank, aspect, from), aspect), 1.0);
                EXPECT_NEAR(reachInPicture(kTank, frameBox(kTank, aspect, from, 0.05), aspect), 0.9, 1e-9);
            }
}

TEST(Camera, BallFrameHasTheReferencesDistance)
{
    const Camera camera = frameBall(kTank, 16.0 / 9.0);
    const double radius = 0.5 * kTank.diagonal().norm();
    EXPECT_NEAR((camera.eye - camera.target).norm(), radius / std::sin(20.0 * std::numbers::pi / 180.0), 1e-12);
    EXPECT_TRUE(camera.target.isApprox(kTank.center()));
    EXPECT_GT((camera.eye - camera.target).z(), 0.0) << "seen along −z";
}

TEST(Camera, OrbitTurnsTheEyeToTheRightAndUp)
{
    const Vector3d target(1.0, 2.0, 3.0);
    EXPECT_TRUE(orbitCamera(target, 5.0, 0.0, 0.0).eye.isApprox(target + Vector3d(0, 0, 5)));
    EXPECT_TRUE(orbitCamera(target, 5.0, 90.0, 0.0).eye.isApprox(target + Vector3d(5, 0, 0)));
    EXPECT_NEAR(orbitCamera(target, 5.0, 40.0, 30.0).eye.y(), target.y() + 2.5, 1e-12);
}

TEST(Camera, ViewIsARigidMotionThatPutsTheTargetAhead)
{
    const Camera camera = orbitCamera({1.0, 2.0, 3.0}, 7.0, 33.0, -21.0);
    const Eigen::Isometry3d view = viewTransform(camera);
    EXPECT_TRUE((view.linear() * view.linear().transpose()).isIdentity(1e-12));
    EXPECT_NEAR(view.linear().determinant(), 1.0, 1e-12);
    EXPECT_TRUE((view * camera.target).isApprox(Vector3d(0, 0, -7.0)));
}

TEST(Camera, ImpossibleViewsAreRefused)
{
    Camera camera;
    camera.eye = camera.target;
    EXPECT_THROW(viewTransform(camera), std::invalid_argument);
    camera.eye = camera.target + 3.0 * camera.up;
    EXPECT_THROW(viewTransform(camera), std::invalid_argument);
}

TEST(Camera, FrameOfTheBoundsContainsAllParticles)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-5.0f, 9.0f);
    std::vector<Eigen::Vector3f> positions(500);
    for (auto& x : positions) x = {uniform(random), 2.0f * uniform(random), uniform(random)};
    FrameView view;
    view.liquid.positions = positions;
    const Camera camera = frameBox(bounds(view), 1.5, orbitCamera(Vector3d::Zero(), 1.0, 20.0, 10.0));
    for (const Eigen::Vector3f& x : positions) {
        const Eigen::Vector4d clip = projection(camera, 1.5, 0.1, 1000.0) * (viewTransform(camera) * x.cast<double>()).homogeneous();
        EXPECT_LT(std::abs(clip.x()), clip.w());
        EXPECT_LT(std::abs(clip.y()), clip.w());
    }
}

TEST(Camera, NothingToFrameLeavesTheCameraAlone)
{
    const Camera camera = orbitCamera({1.0, 2.0, 3.0}, 7.0, 33.0, 21.0);
    EXPECT_EQ(frameBox(Eigen::AlignedBox3d(), 1.0, camera).eye, camera.eye);
    EXPECT_EQ(frameBall(Eigen::AlignedBox3d(), 1.0, camera).eye, camera.eye);
    const Eigen::AlignedBox3d point(Vector3d(1, 1, 1));
    EXPECT_NEAR((frameBox(point, 1.0, camera).eye - Vector3d(1, 1, 1)).norm(), 1.0, 1e-12);
}

}  // namespace
