#include "render/overlay.h"

#include "render/compose.h"

#include <gtest/gtest.h>

namespace {

using namespace render;

const Rgb kPaper = {250, 250, 250};

TEST(Overlay, LabelChangesPixelsOnlyInItsBox)
{
    const Font font;
    for (const Corner corner : {Corner::TopLeft, Corner::TopCenter, Corner::TopRight}) {
        Image image(320, 180, kPaper);
        const PixelBox box = drawLabel(image, font, "PolyPIC λ = 0.5 Ågp", corner, Rgb{0, 0, 0});
        int inked = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (image.color(x, y) == kPaper) continue;
                ++inked;
                ASSERT_TRUE(box.contains(x, y)) << x << ", " << y;
            }
        EXPECT_GT(inked, 200);
        EXPECT_TRUE(box.x >= 0 && box.x + box.width <= 320) << "the text fits";
        EXPECT_LT(box.height, 20);
    }
}

/// The rim has the colour of the paper: nothing of it is seen there, and letters stand out from whatever else is behind them.
TEST(Overlay, LettersAreLegibleOnWhatHasTheirColour)
{
    const Font font;
    const Rgb letters = contrastingColor(kPaper);
    Image plain(640, 480, kPaper), rimmed = plain, dark(640, 480, letters);
    drawLabel(plain, font, "t = 0.124 s", Corner::TopLeft, letters);
    drawLabel(rimmed, font, "t = 0.124 s", Corner::TopLeft, Ink{letters, kPaper});
    EXPECT_TRUE(rimmed == plain);
    const PixelBox box = drawLabel(dark, font, "t = 0.124 s", Corner::TopLeft, Ink{letters, kPaper});
    for (int y = 0; y < dark.height; ++y)
        for (int x = 0; x < dark.width; ++x) ASSERT_TRUE(dark.color(x, y) == letters || box.contains(x, y)) << x << ", " << y;
    int written = 0, legible = 0;
    for (int y = 1; y + 1 < plain.height; ++y)
        for (int x = 1; x + 1 < plain.width; ++x) {
            if (plain.color(x, y).g > 100) continue;
            bool isBeside = false;
            for (const auto& [i, j] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) isBeside = isBeside || dark.color(x + i, y + j).g > 120;
            ++written;
            legible += isBeside;
        }
    EXPECT_GT(written, 30);
    EXPECT_GT(legible, 9 * written / 10) << "of " << written;
}

TEST(Overlay, EmptyTextChangesNothing)
{
    Image image(100, 100, kPaper);
    drawLabel(image, Font(), "", Corner::TopLeft, Rgb{0, 0, 0});
    EXPECT_TRUE(image == Image(100, 100, kPaper));
}

TEST(Overlay, TextGrowsWithItsSizeAndLength)
{
    const Font font;
    EXPECT_NEAR(font.width("speed", 40.0f), 2.0f * font.width("speed", 20.0f), 0.1f);
    EXPECT_GT(font.width("speed [cm/s]", 20.0f), font.width("speed", 20.0f));
    EXPECT_GT(font.capHeight(20.0f), 10.0f);
    EXPECT_LT(font.capHeight(20.0f), 20.0f);
}

TEST(Overlay, BrokenUtf8IsDrawnNotRead)
{
    const Font font;
    EXPECT_GT(font.width("\xff\xc3", 20.0f), 0.0f);
    EXPECT_GT(font.width("a\xf0\x9f", 20.0f), font.width("a", 20.0f));
}

TEST(Overlay, ColorBarRunsFromOneEndOfTheMapToTheOther)
{
    Image image(640, 360, kPaper);
    const ColorBar bar = {ColorMap::Viridis, {0.0f, 150.0f}, "speed [cm/s]"};
    const PixelBox box = drawColorBar(image, Font(), bar, contrastingColor(kPaper));
    const ColorTable table = colorTable(ColorMap::Viridis);
    const auto expectLike = [](Rgb a, Rgb b) { EXPECT_LE(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b), 3); };
    expectLike(image.color(box.x, box.y), toRgb(table.back()));
    expectLike(image.color(box.x + box.width - 1, box.y + box.height - 1), toRgb(table.front()));

    const PixelBox lying = drawLyingColorBar(image, Font(), bar, {0, 300, 640, 60}, 16.0f, contrastingColor(kPaper));
    expectLike(image.color(lying.x, lying.y), toRgb(table.front()));
    expectLike(image.color(lying.x + lying.width - 1, lying.y), toRgb(table.back()));
}

TEST(Overlay, TicksAreRoundNumbersInsideTheRange)
{
    EXPECT_EQ(niceTicks(0.0, 200.0), (std::vector<double>{0.0, 50.0, 100.0, 150.0, 200.0}));
    EXPECT_EQ(niceTicks(0.0, 1.0), (std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
    EXPECT_TRUE(niceTicks(5.0, 5.0).empty());
    for (const double to : {0.3, 1.7, 37.0, 183.0, 9.0e4}) {
        const std::vector<double> ticks = niceTicks(-0.1 * to, to);
        EXPECT_GE(ticks.size(), 3u) << to;
        EXPECT_LE(ticks.size(), 6u) << to;
        EXPECT_GE(ticks.front(), -0.1 * to * (1.0 + 1e-9));
        EXPECT_LE(ticks.back(), to * (1.0 + 1e-9));
    }
}

TEST(Overlay, InkStandsOutFromPaper)
{
    EXPECT_LT(contrastingColor({255, 255, 255}).g, 100);
    EXPECT_GT(contrastingColor({20, 20, 30}).g, 200);
}

std::vector<Image> panels(int count)
{
    std::vector<Image> images;
    for (int i = 0; i < count; ++i) {
        images.emplace_back(161, 91, Rgb{static_cast<std::uint8_t>(40 * i), 90, 200});
        fill(images.back(), {0, 0, 161, 1}, {255, 0, 0});
        fill(images.back(), {160, 0, 1, 91}, {0, 255, 0});
    }
    return images;
}

TEST(Compose, PanelsStayAsTheyAreAndSizesAreEven)
{
    const Font font;
    const std::vector<std::string> labels = {"PIC", "FLIP 0.99", "a label much longer than its panel is wide", "PolyPIC"};
    for (const int count : {1, 2, 3, 4})
        for (const PanelLayout layout : {PanelLayout::Columns, PanelLayout::Rows, PanelLayout::Grid}) {
            const std::vector<Image> images = panels(count);
            ComposeLook look{layout, "Dam break", 0.25, ColorBar{}, {255, 255, 255}};
            const Composition composed = compose(images, std::span(labels).first(count), font, look);
            EXPECT_EQ(composed.image.width % 2, 0);
            EXPECT_EQ(composed.image.height % 2, 0);
            ASSERT_EQ(composed.panels.size(), images.size());
            for (int i = 0; i < count; ++i) {
                const PixelBox& box = composed.panels[i];
                for (int y = 0; y < box.height; ++y)
                    for (int x = 0; x < box.width; ++x) ASSERT_EQ(composed.image.color(box.x + x, box.y + y), images[i].color(x, y));
            }
        }
}

TEST(Compose, LayoutsArrangeColumnsRowsAndGrids)
{
    const Font font;
    const std::vector<Image> images = panels(4);
    const auto arranged = [&](PanelLayout layout) {
        ComposeLook look;
        look.layout = layout;
        return compose(images, {}, font, look);
    };
    const Composition columns = arranged(PanelLayout::Columns);
    const Composition rows = arranged(PanelLayout::Rows);
    const Composition grid = arranged(PanelLayout::Grid);
    EXPECT_EQ(columns.panels[0].y, columns.panels[3].y);
    EXPECT_LT(columns.panels[0].x + 160, columns.panels[1].x);
    EXPECT_EQ(rows.panels[0].x, rows.panels[3].x);
    EXPECT_EQ(grid.panels[0].x, grid.panels[2].x);
    EXPECT_EQ(grid.panels[0].y, grid.panels[1].y);
}

TEST(Compose, WhatDoesNotFitTogetherIsRefused)
{
    const Font font;
    std::vector<Image> images = panels(2);
    const std::vector<std::string> one = {"PIC"};
    EXPECT_THROW(compose({}, {}, font), std::invalid_argument);
    EXPECT_THROW(compose(images, one, font), std::invalid_argument);
    images[1] = Image(10, 10);
    EXPECT_THROW(compose(images, {}, font), std::invalid_argument);
}

TEST(Font, MissingFileNamesThePackage)
{
    try {
        const Font font("no/such/font.ttf");
        FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("fonts-dejavu-core"), std::string::npos);
    }
}

}  // namespace
