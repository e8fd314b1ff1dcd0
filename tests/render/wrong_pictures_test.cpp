// What the gate of golden pictures is for: pictures with one thing wrong in them must not pass, nor any golden for another.

#include "render/image_compare.h"
#include "tests/render/drawing.h"
#include "tests/render/fake_dam_break.h"
#include "tests/render/fake_fabric.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>

namespace {

using namespace render;

/// A dam break in its tank, and a weave under a ball, as they should be.
struct Stage {
    FakeDamBreak dam{1.0f};  ///< of particles several pixels across
    FakeSheet sheet{24};
    Drawing drawing;
    FrameView view;  ///< borrows from the others
    bool isFabric = false;

    explicit Stage(bool fabric) : isFabric(fabric)
    {
        view = fabric ? sheet.view() : dam.view();
        drawing.look.samples = 4;
        drawing.look.overlay = {};
        drawing.look.overlay.label = "PolyPIC";
        drawing.camera = frameBox(bounds(view), 16.0 / 9.0, orbitCamera(Eigen::Vector3d::Zero(), 1.0, 18.0, 14.0));
        if (!fabric) return;
        drawing.look.obstacles.style = ObstacleStyle::Solid;
        drawing.camera = orbitCamera({0.0, -0.3, 0.0}, 4.4, 18.0, 35.0);
    }
    Image draw() { return drawing.renderer.draw(view, drawing.camera, drawing.look); }
};

struct Wrong {
    const char* name;
    bool isFabric;
    std::function<void(Stage&)> spoil;
};

/// Every particle where it is a frame of 4 ms later at its speed.
void fallOn(Stage& stage)
{
    for (std::size_t p = 0; p < stage.dam.positions.size(); ++p) stage.dam.positions[p].y() -= 0.004f * stage.dam.speeds[p];
}

const Wrong kWrongPictures[] = {
    {"ObstacleMissing", false, [](Stage& s) { s.view.obstacles = {}; }},
    {"ColorBarShiftedByOneTick", false,
     [](Stage& s) {
         s.drawing.look.liquid.range = {50.0f, 250.0f};
     }},
    {"ParticlesHalfAsLarge", false, [](Stage& s) { s.drawing.look.liquid.radiusFactor = 0.5f; }},
    {"WrongColorMap", false, [](Stage& s) { s.drawing.look.liquid.colorMap = ColorMap::Turbo; }},
    {"OneFrameLate", false, fallOn},
    {"TimeOfTheNextFrame", false, [](Stage& s) { s.view.time += 0.004; }},
    {"LabelOfAnother", false, [](Stage& s) { s.drawing.look.overlay.label = "PolyFLIP"; }},
    {"SeenFromOneDegreeBeside", false,
     [](Stage& s) { s.drawing.camera = frameBox(bounds(s.view), 16.0 / 9.0, orbitCamera(Eigen::Vector3d::Zero(), 1.0, 19.0, 14.0)); }},
    {"LiquidWithoutShading", false, [](Stage& s) { s.drawing.look.liquid.depthShading = 0.0f; }},
    {"EdgesNotSmooth", false, [](Stage& s) { s.drawing.look.samples = 1; }},
    {"ShadowMissing", true, [](Stage& s) { s.drawing.look.occlusion = 0.0f; }},
    {"PliesMissing", true, [](Stage& s) { s.drawing.look.yarns.plies = 0.0f; }},
    {"YarnsMissing", true, [](Stage& s) { s.drawing.look.yarns.isShown = false; }},
};

class WrongPictures : public testing::TestWithParam<Wrong> {};

TEST_P(WrongPictures, DoNotPass)
{
    const Wrong& wrong = GetParam();
    Stage right(wrong.isFabric), spoiled(wrong.isFabric);
    wrong.spoil(spoiled);
    const Image expected = right.draw();
    EXPECT_TRUE(isWithin(compareImages(expected, right.draw()), ImageTolerance{})) << "drawn twice";
    const ImageDifference difference = compareImages(expected, spoiled.draw());
    EXPECT_FALSE(isWithin(difference, ImageTolerance{}))
        << "mean " << difference.similarity.mean << ", lowest " << difference.similarity.lowest << ", pixels " << difference.color.share;
}

INSTANTIATE_TEST_SUITE_P(Golden, WrongPictures, testing::ValuesIn(kWrongPictures), [](const auto& test) { return std::string(test.param.name); });

TEST(GoldenPairs, NoGoldenPassesForAnother)
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(RENDER_TEST_GOLDEN_DIR)) files.push_back(entry.path());
    int compared = 0;
    for (const auto& a : files)
        for (const auto& b : files) {
            const Image imageA = readPng(a), imageB = readPng(b);
            if (imageA.width != imageB.width || imageA.height != imageB.height) continue;
            EXPECT_EQ(isWithin(compareImages(imageA, imageB), ImageTolerance{}), a == b) << a << b;
            ++compared;
        }
    EXPECT_GE(compared, 25) << "of one size";
}

}  // namespace
