#include "render/color_map.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace render;
using Eigen::Vector3f;

TEST(ColorMap, JetIsItsFormula)
{
    const ColorTable table = colorTable(ColorMap::Jet);
    const auto unit = [](double x) { return std::clamp(x, 0.0, 1.0); };
    for (int i = 0; i < 256; ++i) {
        const double u = (i + 1) / 64.0;
        EXPECT_NEAR(table[i].x(), unit(std::min(u - 1.5, 4.5 - u)), 1e-6);
        EXPECT_NEAR(table[i].y(), unit(std::min(u - 0.5, 3.5 - u)), 1e-6);
        EXPECT_NEAR(table[i].z(), unit(std::min(u + 0.5, 2.5 - u)), 1e-6);
    }
    EXPECT_TRUE(table.front().isApprox(Vector3f(0.0f, 0.0f, 0.515625f)));
    EXPECT_TRUE(table.back().isApprox(Vector3f(0.5f, 0.0f, 0.0f)));
}

TEST(ColorMap, PublishedColorsOfTurboAndViridis)
{
    // Viridis is a polynomial, good to a few percent at its bright end.
    const auto expectNear = [](const Vector3f& color, const Vector3f& published, float tolerance) {
        EXPECT_LT((color - published).cwiseAbs().maxCoeff(), tolerance) << color.transpose();
    };
    const ColorTable viridis = colorTable(ColorMap::Viridis);
    expectNear(viridis[0], {0.267004f, 0.004874f, 0.329415f}, 0.012f);
    expectNear(viridis[128], {0.127568f, 0.566949f, 0.550556f}, 0.012f);
    expectNear(viridis[255], {0.993248f, 0.906157f, 0.143936f}, 0.025f);
    const ColorTable turbo = colorTable(ColorMap::Turbo);
    expectNear(turbo[0], {0.18995f, 0.07176f, 0.23217f}, 1e-5f);
    expectNear(turbo[8], {0.22500f, 0.16354f, 0.45096f}, 0.01f);
    expectNear(turbo[67], {0.13886f, 0.76279f, 0.89550f}, 0.01f);
    expectNear(turbo[82], {0.09451f, 0.87844f, 0.74265f}, 0.01f);
    expectNear(turbo[128], {0.64362f, 0.98999f, 0.23356f}, 0.01f);
    expectNear(turbo[248], {0.57103f, 0.04474f, 0.00529f}, 0.01f);
    expectNear(turbo[255], {0.47960f, 0.01583f, 0.01055f}, 1e-5f);
}

TEST(ColorMap, ViridisGetsEverBrighter)
{
    const ColorTable table = colorTable(ColorMap::Viridis);
    const Vector3f weights(0.2126f, 0.7152f, 0.0722f);
    for (int i = 1; i < kColorMapSize; ++i) EXPECT_GT(weights.dot(table[i]), weights.dot(table[i - 1]) - 1e-3f) << i;
}

TEST(ColorMap, ValuesOutsideGetTheNearerEnd)
{
    const ColorTable table = colorTable(ColorMap::Jet);
    EXPECT_EQ(colorAt(table, -3.0f), table.front());
    EXPECT_EQ(colorAt(table, 7.0f), table.back());
    EXPECT_TRUE(colorAt(table, 100.5f / 255.0f).isApprox(0.5f * (table[100] + table[101]), 1e-4f));
}

}  // namespace
