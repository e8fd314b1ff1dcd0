#include "tests/render/fake_liquid_surface.h"

#include "tests/render/drawing.h"

#include <gtest/gtest.h>

namespace {

using namespace render;

constexpr Rgb kWhite = {255, 255, 255};

/// One ball of radius 1 cm whose values grow from 0 at its left end to 200 at its right, and beside it a particle.
struct BallDrawing : Drawing {
    BallDrawing()
    {
        surface.addBall(Eigen::Vector3f::Zero(), radius, 48);
        for (const Eigen::Vector3f& x : surface.positions) surface.values.push_back(100.0f + 100.0f * x.x());
        add({2.5f, 0.0f, 0.0f}, 100.0f);
        look.liquid.pointPixels = 16.0f;
        look.liquid.style = LiquidStyle::Surface;
    }
    Image draw()
    {
        FrameView seen = view();
        seen.surface = surface.view();
        return renderer.draw(seen, camera, look);
    }
    FakeLiquidSurface surface;
};

int brightness(const Rgb& color) { return color.r + color.g + color.b; }

TEST(LiquidSurface, CoversTheAreaOfItsOutlineAndNoParticles)
{
    BallDrawing drawing;
    const double radius = drawing.outlineRadius(10.0), area = std::numbers::pi * radius * radius;
    const Image image = drawing.draw();
    EXPECT_NEAR(countUnlike(image, kWhite), area, 0.03 * area);
    EXPECT_EQ(image.color(160 + static_cast<int>(2.5 * radius), 90), kWhite);
}

TEST(LiquidSurface, IsDrawnInItsStyleOnly)
{
    BallDrawing drawing;
    const double radius = drawing.outlineRadius(10.0);
    for (const LiquidStyle style : {LiquidStyle::Spheres, LiquidStyle::Points}) {
        drawing.look.liquid.style = style;
        const Image image = drawing.draw();
        EXPECT_EQ(image.color(160, 90), kWhite);
        EXPECT_NE(image.color(160 + static_cast<int>(2.5 * radius), 90), kWhite);
    }
    drawing.look.liquid.style = LiquidStyle::Surface;
    drawing.look.liquid.isShown = false;
    EXPECT_EQ(countUnlike(drawing.draw(), kWhite), 0);
}

/// Jet: blue on the left, red on the right. A flat look has one colour for both, and needs no values.
TEST(LiquidSurface, HasTheColoursOfItsValues)
{
    BallDrawing drawing;
    const int side = static_cast<int>(0.8 * drawing.outlineRadius(10.0));
    const Image image = drawing.draw();
    const Rgb left = image.color(160 - side, 90), right = image.color(160 + side, 90);
    EXPECT_GT(left.b, left.r + 60);
    EXPECT_GT(right.r, right.b + 60);
    drawing.look.liquid.flat = true;
    drawing.look.liquid.flatColor = {0.2f, 0.6f, 0.2f};
    drawing.surface.values.clear();
    const Image flat = drawing.draw();
    for (const int x : {160 - side, 160 + side}) EXPECT_GT(flat.color(x, 90).g, flat.color(x, 90).r + 40);
}

/// The key light comes from the upper left.
TEST(LiquidSurface, IsLitByItsNormals)
{
    BallDrawing drawing;
    drawing.look.liquid.flat = true;
    const int side = static_cast<int>(0.55 * drawing.outlineRadius(10.0));
    const Image image = drawing.draw();
    EXPECT_GT(brightness(image.color(160 - side, 90 - side)), brightness(image.color(160 + side, 90 + side)) + 60);
    for (Eigen::Vector3f& n : drawing.surface.normals) n = Eigen::Vector3f(0.0f, 0.0f, 1.0f);
    const Image flat = drawing.draw();
    EXPECT_NEAR(brightness(flat.color(160 - side, 90 - side)), brightness(flat.color(160 + side, 90 + side)), 30);
}

TEST(LiquidSurface, MustBeConsistent)
{
    const auto draws = [](auto&& spoil) {
        BallDrawing drawing;
        spoil(drawing.surface);
        drawing.draw();
    };
    EXPECT_NO_THROW(draws([](FakeLiquidSurface&) {}));
    EXPECT_THROW(draws([](FakeLiquidSurface& s) { s.values.pop_back(); }), std::invalid_argument);
    EXPECT_THROW(draws([](FakeLiquidSurface& s) { s.normals.pop_back(); }), std::invalid_argument);
    EXPECT_THROW(draws([](FakeLiquidSurface& s) { s.triangles.push_back({0, 1, 100000}); }), std::invalid_argument);
    EXPECT_THROW(draws([](FakeLiquidSurface& s) { s.triangles.push_back({0, -1, 2}); }), std::invalid_argument);
}

TEST(LiquidSurface, IsInTheBoxOfEverything)
{
    FakeLiquidSurface surface;
    surface.addBall({1.0f, 2.0f, 3.0f}, 0.5f, 24);
    FrameView view;
    view.surface = surface.view();
    EXPECT_LT((bounds(view).center() - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 0.01);
    EXPECT_NEAR(bounds(view).sizes().y(), 1.0, 0.01);
}

}  // namespace
