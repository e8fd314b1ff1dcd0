#include "tests/sim/surface/bodies.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

double worstVelocity(const SurfaceMesh& mesh, const Vec3& v0, const Mat3& gradient)
{
    double worst = 0.0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) worst = std::max(worst, (mesh.velocities[v] - v0 - gradient * mesh.positions[v]).norm());
    return mesh.velocities.size() == mesh.positions.size() ? worst : 1.0e9;
}

TEST(SurfaceVelocity, IsThatOfABodyInTranslation)
{
    const Vec3 v0(30.0, -200.0, 70.0);
    LiquidSurface surface;
    for (Body& body : bodies()) {
        setVelocities(body.liquid, v0, Mat3::Zero());
        EXPECT_LT(worstVelocity(surface.find(body.liquid, kDensity), v0, Mat3::Zero()), 1.0e-6 * v0.norm()) << body.name;
    }
}

TEST(SurfaceVelocity, IsThatOfABodyThatTurnsAndIsStrained)
{
    const Vec3 v0(30.0, -200.0, 70.0);
    Mat3 turn, strain;
    turn << 0.0, -30.0, 20.0, 30.0, 0.0, -10.0, -20.0, 10.0, 0.0;
    strain << 20.0, 5.0, 0.0, -15.0, 10.0, 8.0, 3.0, 0.0, -30.0;
    LiquidSurface surface;
    for (const Mat3& gradient : {turn, strain})
        for (LiquidParticles liquid : {ball(1.0, 0.25), box({0.7, 1.1, 1.6}, 0.5), box({1.5, 2.0 * kPitch, 1.7})}) {
            setVelocities(liquid, v0, gradient);
            EXPECT_LT(worstVelocity(surface.find(liquid, kDensity), v0, gradient), 0.04 * gradient.norm() * kPitch);
        }
}

/// One layer says nothing of how the velocity changes away from it: the velocity in the layer holds.
TEST(SurfaceVelocity, OfALayerIsThatInIt)
{
    Mat3 gradient = Mat3::Zero();
    gradient(0, 1) = 40.0, gradient(2, 0) = 25.0, gradient(1, 2) = -15.0;
    LiquidParticles liquid = box({1.5, kPitch, 1.7});
    setVelocities(liquid, Vec3::Zero(), gradient);
    gradient.col(1).setZero();
    LiquidSurface surface;
    EXPECT_LT(worstVelocity(surface.find(liquid, kDensity), Vec3::Zero(), gradient), 0.04 * gradient.norm() * kPitch);
}

TEST(SurfaceVelocity, IsLeftOutWhereItIsNotAskedFor)
{
    LiquidSurface surface;
    const SurfaceMesh& mesh = surface.find(ball(0.3), kDensity, {.hasVelocities = false});
    EXPECT_FALSE(mesh.positions.empty());
    EXPECT_TRUE(mesh.velocities.empty());
}

}  // namespace
}  // namespace sim::test
