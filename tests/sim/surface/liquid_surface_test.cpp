#include "tests/sim/surface/bodies.h"

#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

struct Body {
    const char* name;
    LiquidParticles liquid;
};

std::vector<Body> bodies()
{
    std::vector<Body> all = {{"ball", ball(1.0)},
                             {"shaken ball", ball(1.0, 0.5)},
                             {"box", box({0.7, 1.1, 1.6})},
                             {"shaken box", box({0.7, 1.1, 1.6}, 0.5)},
                             {"sheet of two layers", box({1.5, 2.0 * kPitch, 1.7})},
                             {"shaken sheet of three layers", box({1.5, 3.0 * kPitch, 1.7}, 0.4)}};
    return all;
}

TEST(LiquidSurface, IsClosedAndFacesOutwards)
{
    LiquidSurface surface;
    for (const Body& body : bodies()) {
        const SurfaceMesh& mesh = surface.find(body.liquid, kDensity);
        EXPECT_TRUE(isClosed(mesh)) << body.name;
        EXPECT_EQ(2, eulerCharacteristic(mesh)) << body.name;
        EXPECT_GT(enclosedVolume(mesh), 0.0) << body.name;
    }
}

TEST(LiquidSurface, EnclosesTheVolumeOfTheLiquid)
{
    LiquidSurface surface;
    for (const Body& body : bodies()) {
        const SurfaceMesh& mesh = surface.find(body.liquid, kDensity);
        const double volume = kPitch * kPitch * kPitch * static_cast<double>(body.liquid.count);
        EXPECT_NEAR(volume, enclosedVolume(mesh), 0.02 * volume) << body.name;
    }
}

}  // namespace
}  // namespace sim::test
