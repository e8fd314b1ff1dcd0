#include "sim/coupling/mixture_face.h"
#include "sim/core/types.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace sim {
namespace {

struct Speeds {
    double liquid, fabric;
};

MixtureFace randomFace(testing::Noise& noise)
{
    const auto positive = [&] { return 1.0 + 0.99 * noise.vector().x(); };
    return {positive(), positive(), positive(), positive(), positive() * 10.0, 0.5 * positive()};
}

/// Both equations (coupling/README.md, Mixture) as they stand, without elasticity.
Speeds solved(const MixtureFace& f, Speeds predicted, double pressureImpulse)
{
    Eigen::Matrix2d a;
    a << f.liquidMass + f.drag, -f.drag, -f.drag, f.fabricMass + f.drag;
    const Eigen::Vector2d b(f.liquidMass * predicted.liquid - pressureImpulse * f.liquidVolume,
                            f.fabricMass * predicted.fabric - pressureImpulse * f.fabricVolume);
    const Eigen::Vector2d u = a.inverse() * b;
    return {u[0], u[1]};
}

/// The closed form of u_f and u_s (coupling/README.md, Mixture) solves the 2×2 system of both phases under drag and pressure.
TEST(MixtureFace, SolvesTheTwoPhases)
{
    testing::Noise noise(2);
    for (int i = 0; i < 100; ++i) {
        const MixtureFace f = randomFace(noise);
        const Speeds predicted = {10.0 * noise.vector().x(), 10.0 * noise.vector().x()};
        const double impulse = noise.vector().x();  // dt ∇p
        const Speeds u = solved(f, predicted, impulse);
        const MixtureSplit s = splitMixture(f);
        const double liquid = f.liquidMass * predicted.liquid, fabric = f.fabricMass * predicted.fabric;
        const double byLiquid = s.perLiquidMass * (liquid + s.fabricPart * fabric - impulse * (f.liquidVolume + s.fabricPart * f.fabricVolume));
        const double byFabric = s.perFabricMass * (fabric + s.liquidPart * liquid - impulse * (f.fabricVolume + s.liquidPart * f.liquidVolume));
        EXPECT_NEAR(byLiquid, u.liquid, 1.0e-12 * 10.0);
        EXPECT_NEAR(byFabric, u.fabric, 1.0e-12 * 10.0);
        const double mixed = (1.0 - f.fraction) * u.liquid + f.fraction * u.fabric;
        EXPECT_NEAR(s.ofLiquid * predicted.liquid + s.ofFabric * predicted.fabric - s.mobility * impulse, mixed, 1.0e-12 * 10.0);
    }
}

TEST(MixtureFace, MobilityInItsLimits)
{
    testing::Noise noise(3);
    for (int i = 0; i < 20; ++i) {
        MixtureFace f = randomFace(noise);
        f.drag = 0.0;
        const double apart = (1.0 - f.fraction) * f.liquidVolume / f.liquidMass + f.fraction * f.fabricVolume / f.fabricMass;
        EXPECT_NEAR(splitMixture(f).mobility, apart, 1.0e-13 * apart);
        f.drag = 1.0e12;
        const double together = (f.liquidVolume + f.fabricVolume) / (f.liquidMass + f.fabricMass);
        EXPECT_NEAR(splitMixture(f).mobility, together, 1.0e-10 * together);
    }
    MixtureFace alone;
    alone.liquidMass = 0.03;
    alone.liquidVolume = 0.02;
    EXPECT_DOUBLE_EQ(splitMixture(alone).mobility, 0.02 / 0.03);
    EXPECT_EQ(splitMixture(alone).ofLiquid, 1.0);
    EXPECT_EQ(splitMixture(MixtureFace()).mobility, 0.0);
    EXPECT_EQ(splitMixture(MixtureFace()).ofFabric, 0.0);
}

/// Backward Euler of two phases that drag each other (coupling/README.md, Mixture).
TEST(MixtureFace, RelativeVelocityDecaysAndMomentumStays)
{
    testing::Noise noise(4);
    const MixtureFace f = randomFace(noise);
    const MixtureSplit s = splitMixture(f);
    Speeds u = {30.0, -10.0};
    const double momentum = f.liquidMass * u.liquid + f.fabricMass * u.fabric;
    const double decay = 1.0 / (1.0 + f.drag * (1.0 / f.liquidMass + 1.0 / f.fabricMass));
    for (int step = 0; step < 5; ++step) {
        const double apart = u.liquid - u.fabric, liquid = f.liquidMass * u.liquid, fabric = f.fabricMass * u.fabric;
        u = {s.perLiquidMass * (liquid + s.fabricPart * fabric), s.perFabricMass * (fabric + s.liquidPart * liquid)};
        EXPECT_NEAR(u.liquid - u.fabric, decay * apart, 1.0e-13 * 40.0);
        EXPECT_NEAR(f.liquidMass * u.liquid + f.fabricMass * u.fabric, momentum, 1.0e-13 * 40.0);
    }
}

}  // namespace
}  // namespace sim
