#include "tests/render/drawing.h"
#include "tests/render/fake_fabric.h"

#include <gtest/gtest.h>

namespace {

using namespace render;
using Eigen::Vector3f;

constexpr Rgb kWhite = {255, 255, 255};

struct LineDrawing : Drawing {
    Image draw()
    {
        const FrameView::Lines lines = {
            .points = points, .color = {1.0f, 0.0f, 0.0f}, .width = width, .isTapered = isTapered, .rim = rim, .lift = lift};
        FrameView all = view();
        all.lines = {&lines, 1};
        return renderer.draw(all, camera, look);
    }
    /// In the plane through the origin that faces the camera.
    double pixelsPerCm() const { return 0.5 * look.height / std::tan(0.5 * camera.fovDegrees * std::numbers::pi / 180.0) / 10.0; }

    std::vector<Vector3f> points = {{-1.5f, 1.0f, 0.0f}, {1.5f, 1.0f, 0.0f}};
    float width = 16.0f;  ///< 4 pixels in a picture of 180
    bool isTapered = false;
    float rim = 0.0f, lift = 0.0f;
};

/// What the pixels have of the red of the lines, and where.
struct Ink {
    explicit Ink(const Image& image)
    {
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const Rgb color = image.color(x, y);
                const double share = (color.r - color.g) / 255.0;
                area += share, sumX += share * (x + 0.5), sumY += share * (y + 0.5);
            }
    }
    double x() const { return sumX / area; }
    double y() const { return sumY / area; }
    double area = 0.0, sumX = 0.0, sumY = 0.0;  ///< [pixels]
};

TEST(Lines, StandWhereTheCameraHasThem)
{
    for (const int samples : {1, 4}) {
        LineDrawing drawing;
        drawing.look.samples = samples;
        drawing.points = {{-0.5f, 0.5f, 0.0f}, {1.5f, 1.0f, 0.0f}};
        const Ink ink(drawing.draw());
        const double scale = drawing.pixelsPerCm();
        EXPECT_NEAR(ink.x(), 160.0 + 0.5 * scale, 0.3) << samples;
        EXPECT_NEAR(ink.y(), 90.0 - 0.75 * scale, 0.3) << samples;
        EXPECT_NEAR(ink.area, 4.0 * scale * std::hypot(2.0, 0.5), 0.05 * ink.area) << "length x 4 pixels";
    }
}

TEST(Lines, AreAsWideInEveryPictureOfASize)
{
    LineDrawing drawing;
    const double near = Ink(drawing.draw()).area;
    drawing.camera.eye.z() = 20.0;
    EXPECT_NEAR(Ink(drawing.draw()).area, 0.5 * near, 0.03 * near) << "half as long, as wide";
    drawing.look.width *= 2, drawing.look.height *= 2;
    EXPECT_NEAR(Ink(drawing.draw()).area, 2.0 * near, 0.05 * near) << "twice as long, twice as wide";
}

TEST(Lines, ATaperedOneEndsInAPoint)
{
    LineDrawing drawing;
    const double area = Ink(drawing.draw()).area;
    drawing.isTapered = true;
    const Ink ink(drawing.draw());
    EXPECT_NEAR(ink.area, 0.5 * area, 0.05 * area);
    EXPECT_NEAR(ink.x(), 160.0 - 0.5 * drawing.pixelsPerCm(), 1.0) << "a third of the way";
}

TEST(Lines, AreHiddenBehindASolid)
{
    LineDrawing drawing;
    const CubeMesh cube(2.0f);
    drawing.meshes = {cube.mesh(false)};
    drawing.look.obstacles.style = ObstacleStyle::Solid;
    const Image cubeAlone = drawing.Drawing::draw();
    EXPECT_TRUE(drawing.draw() == cubeAlone) << "inside the cube";
    for (Vector3f& x : drawing.points) x.z() = 1.9f;
    EXPECT_TRUE(drawing.draw() == cubeAlone) << "just below its front";
    for (Vector3f& x : drawing.points) x.z() = 2.1f;
    EXPECT_GT(Ink(drawing.draw()).area - Ink(cubeAlone).area, 150.0) << "just in front of it";
}

/// A lifted line comes out of what is thinner than the lift, where it is, and stays behind what is not.
TEST(Lines, AreLiftedOutOfThinThings)
{
    LineDrawing drawing;
    const double free = Ink(drawing.draw()).y();
    const CubeMesh cube(2.0f);
    drawing.meshes = {cube.mesh(false)};
    drawing.look.obstacles.style = ObstacleStyle::Solid;
    const Image cubeAlone = drawing.Drawing::draw();
    drawing.lift = 1.9f;
    EXPECT_TRUE(drawing.draw() == cubeAlone);
    drawing.lift = 2.1f;
    Image image = drawing.draw();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            if (image.color(x, y) == cubeAlone.color(x, y)) image.at(x, y)[0] = image.at(x, y)[1] = 0;
    EXPECT_GT(Ink(image).area, 150.0);
    EXPECT_NEAR(Ink(image).y(), free, 0.5) << "where it is without the cube";
    drawing.lift = 1000.0f;
    EXPECT_GT(Ink(drawing.draw()).area - Ink(cubeAlone).area, 150.0) << "not lost before the near plane";
}

TEST(Lines, AreHiddenBehindLiquid)
{
    LineDrawing drawing;
    drawing.look.liquid.depthShading = 0.0f;
    drawing.radius = 0.5f;
    drawing.look.liquid.flat = true;
    drawing.look.liquid.flatColor = {0.0f, 0.0f, 1.0f};
    drawing.add({0.0f, 1.0f, 1.0f}, 0.0f);
    const Image image = drawing.draw();
    const auto middleY = static_cast<int>(90.0 - 1.0 * drawing.pixelsPerCm());
    EXPECT_LT(image.color(160, middleY).r, 100) << "the ball is in front";
    EXPECT_GT(image.color(160 - 30, middleY).r, 200);
    EXPECT_LT(image.color(160 - 30, middleY).g, 60);
}

/// White on dark, on all sides; on white it is not seen.
TEST(Lines, HaveARim)
{
    LineDrawing drawing;
    const Image onWhite = drawing.draw();
    drawing.look.background.setZero();
    const Image bare = drawing.draw();
    drawing.rim = 8.0f;  // 2 pixels
    const Image rimmed = drawing.draw();
    int rim = 0;
    for (int y = 0; y < bare.height; ++y)
        for (int x = 0; x < bare.width; ++x) rim += (rimmed.color(x, y).b - bare.color(x, y).b) / 128;
    const double length = 3.0 * drawing.pixelsPerCm();
    EXPECT_NEAR(rim, 2.0 * (2.0 * length + 2.0 * 8.0), 0.1 * rim) << "2 pixels above and below, and at both ends";
    EXPECT_EQ(Ink(rimmed).area, Ink(bare).area);
    drawing.look.background.setOnes();
    EXPECT_NEAR(Ink(drawing.draw()).area, Ink(onWhite).area, 1.0);
}

/// Not even each other: what is drawn later is on top.
TEST(Lines, HideNothing)
{
    Drawing drawing;
    const std::array<Vector3f, 2> near = {{{-1.0f, 0.0f, 2.0f}, {1.0f, 0.0f, 2.0f}}}, far = {{{0.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
    const std::array<FrameView::Lines, 2> lines = {
        {{.points = near, .color = {1.0f, 0.0f, 0.0f}, .width = 16.0f}, {.points = far, .color = {0.0f, 0.0f, 1.0f}, .width = 16.0f}}};
    FrameView view = drawing.view();
    view.lines = lines;
    const Image image = drawing.renderer.draw(view, drawing.camera, drawing.look);
    EXPECT_EQ(image.color(160, 90), (Rgb{0, 0, 255}));
    EXPECT_EQ(image.color(170, 90), (Rgb{255, 0, 0}));
}

/// A line that begins behind the camera is cut where the picture begins, not lost.
TEST(Lines, ComeFromBehindTheCamera)
{
    LineDrawing drawing;
    drawing.points = {{0.0f, -1.0f, 0.0f}, {0.0f, -1.0f, 30.0f}};
    const Ink ink(drawing.draw());
    EXPECT_NEAR(ink.x(), 160.0, 0.5);
    EXPECT_GT(ink.y(), 130.0) << "down to the lower edge";
}

TEST(Lines, NoneLeaveThePictureAsItIs)
{
    LineDrawing drawing;
    drawing.add({0.5f, 1.0f, 0.0f}, 100.0f);
    const CubeMesh cube(1.0f);
    drawing.meshes = {cube.mesh(true)};
    drawing.points.clear();
    EXPECT_TRUE(drawing.draw() == drawing.Drawing::draw());
}

TEST(Lines, NeedTwoPointsEach)
{
    LineDrawing drawing;
    drawing.points.pop_back();
    EXPECT_THROW(drawing.draw(), std::invalid_argument);
}

struct AllThings : Drawing {
    AllThings()
    {
        add({0.0f, 1.0f, 0.0f}, 100.0f);
        radius = 0.3f;
        for (int i = 0; i < 9; ++i) yarns.add({0.25f * static_cast<float>(i) - 1.0f, -1.0f, 0.0f}, Vector3f::UnitY());
        yarns.endStrand(0.1f, 0.1f);
        all = view();
        all.yarns = yarns.view();
        all.cloth = {corners, triangles, thickness, materials, values};
        look.cloth.byValue = true;
        look.overlay.colorBar = true;
    }
    Image draw() { return renderer.draw(all, camera, look); }

    FakeYarns yarns;
    std::vector<Vector3f> corners = {{-2.0f, 0.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, {-1.5f, 1.0f, 0.0f}};
    std::vector<Eigen::Vector3i> triangles = {{0, 1, 2}};
    std::vector<float> thickness = {0.02f, 0.02f, 0.02f}, values = {0.0f, 0.5f, 1.0f};
    std::vector<int> materials = {0, 0, 0};
    FrameView all;
};

/// What is not shown is not there: not in the picture, and its bar neither.
TEST(Look, ShowsWhatItIsToldTo)
{
    AllThings things;
    const Image everything = things.draw();
    const auto same = [&](auto&& hide, auto&& remove) {
        AllThings hidden, removed;
        hide(hidden.look);
        remove(removed);
        const Image image = hidden.draw();
        EXPECT_FALSE(image == everything);
        EXPECT_TRUE(image == removed.draw());
    };
    same([](Look& look) { look.liquid.isShown = false; },
         [](AllThings& t) { t.all.liquid.positions = {}, t.all.liquid.values = {}, t.look.overlay.liquidBar = false; });
    same([](Look& look) { look.yarns.isShown = false; }, [](AllThings& t) { t.all.yarns = {}; });
    same([](Look& look) { look.cloth.isShown = false; }, [](AllThings& t) { t.all.cloth = {}; });
}

}  // namespace
