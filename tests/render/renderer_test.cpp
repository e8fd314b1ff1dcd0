#include "render/renderer.h"

#include "render/gl_objects.h"
#include "render/overlay.h"
#include "tests/render/drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

namespace {

using namespace render;

constexpr Rgb kWhite = {255, 255, 255};

TEST(Renderer, BallCoversTheAreaOfItsOutline)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    const double radius = drawing.outlineRadius(10.0);
    const double area = std::numbers::pi * radius * radius;
    EXPECT_NEAR(countUnlike(drawing.draw(), kWhite), area, 0.03 * area);
}

TEST(Renderer, BallStandsWhereTheCameraSeesIt)
{
    Drawing drawing;
    drawing.radius = 0.2f;
    drawing.add({1.5f, 1.0f, 0.0f}, 100.0f);
    const Image image = drawing.draw();
    const double scale = 0.5 * 180 / std::tan(20.0 * std::numbers::pi / 180.0) / 10.0;  // pixels per cm
    double sumX = 0.0, sumY = 0.0, count = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.color(x, y) != kWhite) sumX += x + 0.5, sumY += y + 0.5, ++count;
    ASSERT_GT(count, 0.0);
    EXPECT_NEAR(sumX / count, 160.0 + 1.5 * scale, 0.5);
    EXPECT_NEAR(sumY / count, 90.0 - 1.0 * scale, 0.5);
}

TEST(Renderer, NearerBallHidesTheFartherInAnyOrder)
{
    Drawing drawing;
    drawing.look.liquid.style = LiquidStyle::Points;
    drawing.look.liquid.pointPixels = 40.0f;
    drawing.look.liquid.depthShading = 0.0f;
    drawing.add({0.0f, 0.0f, 2.0f}, 200.0f);
    drawing.add({0.0f, 0.0f, -2.0f}, 0.0f);
    const Image nearFirst = drawing.draw();
    std::swap(drawing.positions[0], drawing.positions[1]);
    std::swap(drawing.values[0], drawing.values[1]);
    EXPECT_EQ(nearFirst.color(160, 90), toRgb(colorTable(ColorMap::Jet).back()));
    EXPECT_TRUE(drawing.draw() == nearFirst);
}

TEST(Renderer, ColorsAtTheEndsOfTheRangeAreTheMapsEnds)
{
    for (const ColorMap map : {ColorMap::Jet, ColorMap::Turbo, ColorMap::Viridis}) {
        Drawing drawing;
        drawing.look.liquid.style = LiquidStyle::Points;
        drawing.look.liquid.pointPixels = 40.0f;
        drawing.look.liquid.depthShading = 0.0f;
        drawing.look.liquid.colorMap = map;
        drawing.look.liquid.range = {20.0f, 60.0f};
        drawing.add({-1.0f, 0.0f, 0.0f}, 20.0f);
        drawing.add({1.0f, 0.0f, 0.0f}, 60.0f);
        drawing.add({0.0f, 1.0f, 0.0f}, 1000.0f);
        const Image image = drawing.draw();
        EXPECT_EQ(image.color(160 - 25, 90), toRgb(colorTable(map).front()));
        EXPECT_EQ(image.color(160 + 25, 90), toRgb(colorTable(map).back()));
        EXPECT_EQ(image.color(160, 90 - 25), toRgb(colorTable(map).back())) << "beyond the range";
    }
}

TEST(Renderer, MirroredSceneGivesTheMirroredPicture)
{
    Drawing drawing;
    drawing.look.liquid.style = LiquidStyle::Points;  // unlit: the key light is not symmetric
    drawing.look.liquid.pointPixels = 24.0f;
    drawing.look.liquid.depthShading = 0.0f;
    drawing.add({-1.83f, 0.41f, 0.5f}, 30.0f);
    drawing.add({0.77f, -1.13f, -0.5f}, 120.0f);
    drawing.add({2.31f, 0.92f, 0.0f}, 190.0f);
    const Image image = drawing.draw();
    for (Eigen::Vector3f& x : drawing.positions) x.x() = -x.x();
    const Image mirrored = drawing.draw();
    int different = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) different += image.color(x, y) != mirrored.color(image.width - 1 - x, y);
    EXPECT_LE(different, 6) << "pixel centres that fall on an outline may go either way";
    EXPECT_GT(countUnlike(image, kWhite), 80);
}

TEST(Renderer, MoreSamplesChangeNothingButEdges)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    drawing.look.liquid.depthShading = 0.0f;
    const Image one = drawing.draw();
    drawing.look.samples = 4;
    const Image four = drawing.draw();
    const double radius = drawing.outlineRadius(10.0);
    int different = 0;
    for (int y = 0; y < one.height; ++y)
        for (int x = 0; x < one.width; ++x) {
            if (one.color(x, y) == four.color(x, y)) continue;
            ++different;
            const double fromEdge = std::hypot(x + 0.5 - 160.0, y + 0.5 - 90.0) - radius;
            EXPECT_LT(std::abs(fromEdge), 1.5) << "pixel " << x << ", " << y;
        }
    EXPECT_GT(different, 2.0 * radius) << "edges must be smoothed";
}

TEST(Renderer, ColorBarIsTheSameInEveryFrameOfARange)
{
    Drawing drawing;
    drawing.look.overlay.colorBar = true;
    drawing.look.overlay.colorBarTitle = "speed [cm/s]";
    Image blank(320, 180);
    const Font font;
    const PixelBox box = drawColorBar(blank, font, {ColorMap::Jet, {0.0f, 200.0f}, "speed [cm/s]"}, contrastingColor(kWhite));
    for (const float value : {10.0f, 170.0f}) {
        drawing.positions.clear(), drawing.values.clear();
        drawing.add({0.01f * value, 0.0f, 0.0f}, value);
        const Image image = drawing.draw();
        for (int y = box.y; y < box.y + box.height; ++y)
            for (int x = box.x; x < box.x + box.width; ++x) ASSERT_EQ(image.color(x, y), blank.color(x, y));
    }
}

TEST(Renderer, ContainerNeverHidesTheLiquid)
{
    const CubeMesh cube(2.0f);
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    drawing.look.liquid.depthShading = 0.0f;
    const Image alone = drawing.draw();
    drawing.meshes = {cube.mesh(true)};
    drawing.look.obstacles.opacity = 1.0f;
    const Image inTank = drawing.draw();
    EXPECT_GT(countUnlike(inTank, kWhite), countUnlike(alone, kWhite) + 1000) << "the tank is drawn at all";
    const int reach = static_cast<int>(drawing.outlineRadius(10.0)) - 1;
    for (int y = 90 - reach; y <= 90 + reach; ++y)
        for (int x = 160 - reach; x <= 160 + reach; ++x) {
            const bool isLiquid = std::hypot(x - 160, y - 90) < reach;
            ASSERT_TRUE(!isLiquid || inTank.color(x, y) == alone.color(x, y)) << x << ", " << y;
        }
}

TEST(Renderer, ObstacleTintsWhatLiesBehindAndIsHiddenByWhatLiesInFront)
{
    const CubeMesh cube(1.5f);
    Drawing drawing;
    drawing.radius = 0.3f;
    drawing.add({0.0f, 0.0f, -3.0f}, 100.0f);
    const Image bare = drawing.draw();
    drawing.meshes = {cube.mesh(false)};
    EXPECT_NE(drawing.draw().color(160, 90), bare.color(160, 90));

    drawing.positions[0].z() = 3.0f;
    const Image inFront = drawing.draw();
    drawing.meshes.clear();
    EXPECT_EQ(inFront.color(160, 90), drawing.draw().color(160, 90));
}

TEST(Renderer, WireObstacleIsOutlinesOnly)
{
    const CubeMesh cube(1.5f);
    Drawing drawing;
    drawing.meshes = {cube.mesh(false)};
    drawing.look.obstacles.style = ObstacleStyle::Wire;
    const Image wire = drawing.draw();
    EXPECT_EQ(wire.color(160 - 10, 90 + 7), kWhite) << "faces are open, their diagonals are no lines";
    const int lines = countUnlike(wire, kWhite);
    EXPECT_GT(lines, 300);
    EXPECT_LT(lines, 3000);
    drawing.look.obstacles.style = ObstacleStyle::Hidden;
    EXPECT_EQ(countUnlike(drawing.draw(), kWhite), 0);
}

TEST(Renderer, EmptySceneIsTheBackground)
{
    Drawing drawing;
    drawing.look.background = {0.2f, 0.4f, 0.6f};
    EXPECT_EQ(countUnlike(drawing.draw(), {51, 102, 153}), 0);
}

TEST(Renderer, NotANumberIsLeftOut)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    const Image clean = drawing.draw();
    drawing.add({std::nanf(""), 0.0f, 0.0f}, 100.0f);
    EXPECT_TRUE(drawing.draw() == clean);
}

TEST(Renderer, SpansThatDisagreeAreRefused)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    drawing.values.clear();
    EXPECT_THROW(drawing.draw(), std::invalid_argument);
    drawing.look.liquid.flat = true;
    EXPECT_GT(countUnlike(drawing.draw(), kWhite), 1000) << "one colour for all needs no values";
    const CubeMesh cube(1.0f);
    const std::vector<Eigen::Vector3i> wrong = {{0, 1, 8}};
    drawing.meshes = {{cube.positions, wrong, false}};
    EXPECT_THROW(drawing.draw(), std::invalid_argument);
}

TEST(Renderer, MissingShadersAreNamed)
{
    const auto context = makeOsMesaContext();
    try {
        Renderer renderer(*context, "no/such/folder");
        FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no/such/folder"), std::string::npos) << error.what();
    }
}

TEST(Renderer, BrokenShaderIsNamedOnOneLine)
{
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "broken_shaders";
    std::filesystem::remove_all(folder);
    std::filesystem::copy(findShaderDir(), folder);
    std::ofstream(folder / "liquid.frag") << "#version 330 core\nvoid main() { colour = 1; }\n";
    const auto context = makeOsMesaContext();
    try {
        Renderer renderer(*context, folder);
        FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("liquid.frag does not compile"), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    std::filesystem::remove_all(folder);
}

TEST(Renderer, ComesAndGoesTwentyTimesAndDrawsTheSame)
{
    Image first;
    for (int i = 0; i < 20; ++i) {
        Drawing drawing;
        drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
        const Image image = drawing.draw();
        if (i == 0) first = image;
        ASSERT_TRUE(image == first) << "time " << i;
    }
}

TEST(Renderer, SizesMayChangeFromPictureToPicture)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.0f}, 100.0f);
    const Image small = drawing.draw();
    drawing.look.width = 200, drawing.look.height = 400;
    const Image tall = drawing.draw();
    EXPECT_EQ(tall.width, 200);
    EXPECT_EQ(tall.height, 400);
    drawing.look.width = 320, drawing.look.height = 180;
    EXPECT_TRUE(drawing.draw() == small);
}

TEST(Renderer, TwoThreadsWithContextsOfTheirOwnDrawTheSame)
{
    std::array<Image, 2> images;
    std::vector<std::thread> threads;
    for (Image& image : images)
        threads.emplace_back([&image] {
            Drawing drawing;
            for (int i = 0; i < 200; ++i)
                drawing.add({0.03f * static_cast<float>(i % 20 - 10), 0.1f * static_cast<float>(i / 20 - 5), 0.0f}, static_cast<float>(i));
            drawing.radius = 0.2f;
            for (int k = 0; k < 5; ++k) image = drawing.draw();
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_TRUE(images[0] == images[1]);
    EXPECT_GT(countUnlike(images[0], kWhite), 100);
}

TEST(Renderer, TwoContextsInOneThreadDoNotMix)
{
    Drawing a, b;
    a.add({0.0f, 0.0f, 0.0f}, 100.0f);
    b.add({1.0f, 0.0f, 0.0f}, 20.0f);
    const Image firstA = a.draw(), firstB = b.draw();
    EXPECT_TRUE(a.draw() == firstA);
    EXPECT_TRUE(b.draw() == firstB);
    EXPECT_FALSE(firstA == firstB);
}

}  // namespace
