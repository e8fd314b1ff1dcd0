#include "render/compose.h"
#include "render/image_compare.h"
#include "render/renderer.h"
#include "tests/render/drawing.h"
#include "tests/render/fake_dam_break.h"
#include "tests/render/fake_fabric.h"
#include "tests/render/fake_liquid_surface.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

// Whole pictures against stored ones. DRENCH_ACCEPT_GOLDENS=1 stores the present ones instead.

namespace {

using namespace render;
namespace fs = std::filesystem;

void expectLikeGolden(const Image& actual, const std::string& name)
{
    const fs::path golden = fs::path(RENDER_TEST_GOLDEN_DIR) / (name + ".png");
    const char* accept = std::getenv("DRENCH_ACCEPT_GOLDENS");
    if (accept != nullptr && std::string_view(accept) == "1") {
        writePng(actual, golden);
        return;
    }
    const fs::path folder = fs::path(RENDER_TEST_OUTPUT_DIR) / name;
    fs::remove_all(folder);
    ASSERT_TRUE(fs::exists(golden)) << golden << " is missing; DRENCH_ACCEPT_GOLDENS=1 writes it";
    const Image expected = readPng(golden);
    const bool sameSize = actual.width == expected.width && actual.height == expected.height;
    const ImageDifference difference = sameSize ? compareImages(actual, expected) : ImageDifference{};
    if (sameSize && isWithin(difference, ImageTolerance{})) return;
    fs::create_directories(folder);
    writePng(actual, folder / "actual.png");
    if (sameSize) writePng(differenceImage(actual, expected), folder / "diff.png");
    ADD_FAILURE() << name << ": mean similarity " << difference.similarity.mean << ", lowest " << difference.similarity.lowest << " at ("
                  << difference.similarity.x << ", " << difference.similarity.y << "), share of pixels that differ " << difference.color.share
                  << (sameSize ? "" : "; another size") << "\n  expected " << golden << "\n  actual   " << folder / "actual.png"
                  << "\n  diff     " << folder / "diff.png"
                  << "\n  to accept the new picture: DRENCH_ACCEPT_GOLDENS=1";
}

Camera slantedView(const FrameView& view, double aspect)
{
    return frameBox(bounds(view), aspect, orbitCamera(Eigen::Vector3d::Zero(), 1.0, 18.0, 14.0));
}

TEST(Golden, DamBreakInItsTank)
{
    const FakeDamBreak scene(0.3f);
    Drawing drawing;
    drawing.look.samples = 4;
    drawing.look.overlay = {};
    drawing.look.overlay.label = "PolyPIC";
    const FrameView view = scene.view();
    expectLikeGolden(drawing.renderer.draw(view, slantedView(view, 16.0 / 9.0), drawing.look), "dam_break");
}

TEST(Golden, ObstaclesOnDarkGround)
{
    std::vector<Eigen::Vector3f> ball;
    std::vector<Eigen::Vector3i> ballTriangles;
    addBall({-2.2f, 0.0f, 0.0f}, 1.5f, 16, ball, ballTriangles);
    CubeMesh cube(1.2f);
    for (Eigen::Vector3f& x : cube.positions) x.x() += 2.2f;
    Drawing drawing;
    drawing.radius = 0.25f;
    for (int i = 0; i < 60; ++i)
        drawing.add({0.1f * static_cast<float>(i) - 3.0f, 0.6f * std::sin(0.3f * static_cast<float>(i)), -2.0f}, 3.0f * static_cast<float>(i));
    drawing.meshes = {{ball, ballTriangles, false}, cube.mesh(false)};
    drawing.look.samples = 4;
    drawing.look.background = {0.10f, 0.12f, 0.15f};
    drawing.look.liquid.colorMap = ColorMap::Viridis;
    drawing.look.obstacles.color = {0.75f, 0.80f, 0.88f};
    drawing.look.overlay = {};
    drawing.camera = orbitCamera({0.0, 0.0, 0.0}, 9.0, 12.0, 20.0);
    expectLikeGolden(drawing.draw(), "obstacles");
}

/// Three bodies that pass into each other, behind glass: shaded smoothly, darker where they meet, with a bar of colours.
TEST(Golden, SurfaceOfALiquidInItsTank)
{
    FakeLiquidSurface surface;
    surface.addBall({-1.0f, -0.3f, 0.0f}, 1.5f, 64);
    surface.addBall({1.2f, 0.0f, 0.3f}, 1.0f, 64);
    surface.addBall({2.6f, 1.0f, 0.0f}, 0.4f, 48);
    for (const Eigen::Vector3f& x : surface.positions) surface.values.push_back(100.0f + 40.0f * x.x());
    const CubeMesh cube(3.1f);
    Drawing drawing;
    drawing.meshes = {cube.mesh(true)};
    drawing.look.samples = 4;
    drawing.look.overlay.colorBar = true;
    drawing.look.overlay.colorBarTitle = "speed [cm/s]";
    drawing.look.liquid.style = LiquidStyle::Surface;
    drawing.camera = orbitCamera({0.0, 0.0, 0.0}, 12.0, 18.0, 15.0);
    FrameView view = drawing.view();
    view.surface = surface.view();
    expectLikeGolden(drawing.renderer.draw(view, drawing.camera, drawing.look), "liquid_surface");
}

TEST(Golden, ComparisonOfThree)
{
    const FakeDamBreak scene(0.45f);
    Drawing drawing;
    drawing.look.width = 160;
    drawing.look.height = 120;
    drawing.look.samples = 4;
    drawing.look.background = {0.94f, 0.95f, 0.96f};
    std::vector<Image> panels;
    for (const ColorMap map : {ColorMap::Jet, ColorMap::Turbo, ColorMap::Viridis}) {
        drawing.look.liquid.colorMap = map;
        panels.push_back(drawing.renderer.draw(scene.view(), slantedView(scene.view(), 4.0 / 3.0), drawing.look));
    }
    const std::vector<std::string> labels = {"jet", "turbo", "viridis"};
    ComposeLook look;
    look.title = "Dam break";
    look.time = 0.124;
    look.colorBar = ColorBar{};
    expectLikeGolden(compose(panels, labels, Font(), look).image, "comparison");
}

TEST(Golden, WovenSheetUnderABall)
{
    const FakeSheet scene(24);
    Drawing drawing;
    drawing.look.samples = 4;
    drawing.look.obstacles.style = ObstacleStyle::Solid;
    drawing.camera = orbitCamera({0.0, -0.3, 0.0}, 4.4, 18.0, 35.0);
    expectLikeGolden(drawing.renderer.draw(scene.view(), drawing.camera, drawing.look), "woven_sheet");
}

TEST(Golden, ClothOverABallByStrain)
{
    const FakeDrape scene(60);
    Drawing drawing;
    drawing.look.samples = 4;
    drawing.look.obstacles.style = ObstacleStyle::Solid;
    drawing.look.cloth.byValue = true;
    drawing.look.cloth.range = {0.0f, 0.1f};
    drawing.look.overlay.colorBar = true;
    drawing.look.overlay.liquidBar = false;
    drawing.camera = orbitCamera({0.0, -1.2, 0.0}, 14.0, 18.0, 20.0);
    expectLikeGolden(drawing.renderer.draw(scene.view(), drawing.camera, drawing.look), "draped_cloth");
}

}  // namespace
