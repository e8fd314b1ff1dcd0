#include "render/overlay.h"
#include "tests/render/drawing.h"
#include "tests/render/fake_fabric.h"

#include <gtest/gtest.h>

namespace {

using namespace render;
using Eigen::Vector3f;

constexpr Rgb kWhite = {255, 255, 255};

/// Height in pixels of what is drawn in a column.
int heightAt(const Image& image, int x)
{
    int count = 0;
    for (int y = 0; y < image.height; ++y) count += image.color(x, y) != kWhite;
    return count;
}

/// A yarn along x through the middle of the picture, its section turned by `twist` from end to end.
FakeYarns straightYarn(float a, float b, const Vector3f& m1, float twist = 0.0f)
{
    FakeYarns yarns;
    constexpr int kVertices = 61;
    const Vector3f m2 = Vector3f::UnitX().cross(m1);
    for (int i = 0; i < kVertices; ++i) {
        const float u = static_cast<float>(i) / (kVertices - 1);
        yarns.add({8.0f * u - 4.0f, 0.0f, 0.0f}, std::cos(twist * u) * m1 + std::sin(twist * u) * m2, u);
    }
    yarns.endStrand(a, b);
    return yarns;
}

struct FabricDrawing : Drawing {
    Image draw(const FrameView::Yarns& yarns, const FrameView::Cloth& cloth = {})
    {
        FrameView view;
        view.yarns = yarns, view.cloth = cloth, view.obstacles = meshes;
        return renderer.draw(view, camera, look);
    }
    double pixelsPerCm() const { return 0.5 * look.height / std::tan(0.5 * camera.fovDegrees * std::numbers::pi / 180.0) / camera.eye.norm(); }
};

struct FlatCloth {
    FlatCloth(const Vector3f& u, const Vector3f& v, float t)
    {
        for (int j = 0; j < 9; ++j)
            for (int i = 0; i < 9; ++i) {
                positions.push_back((static_cast<float>(i) / 4.0f - 1.0f) * u + (static_cast<float>(j) / 4.0f - 1.0f) * v);
                values.push_back(static_cast<float>(i) / 8.0f);
                if (i < 8 && j < 8)
                    triangles.insert(triangles.end(), {{9 * j + i, 9 * j + i + 1, 9 * j + i + 10}, {9 * j + i, 9 * j + i + 10, 9 * j + i + 9}});
            }
        thickness.assign(positions.size(), t), materials.assign(positions.size(), 0);
    }
    FrameView::Cloth view() const { return {positions, triangles, thickness, materials, values}; }
    std::vector<Vector3f> positions;
    std::vector<Eigen::Vector3i> triangles;
    std::vector<float> thickness, values;
    std::vector<int> materials;
};

TEST(DrawYarns, SilhouetteIsAsWideAsTheAxisOfTheSectionAcrossTheView)
{
    FabricDrawing drawing;
    constexpr float kA = 0.6f, kB = 0.3f;
    const double a = drawing.pixelsPerCm() * 2.0 * kA, b = drawing.pixelsPerCm() * 2.0 * kB;
    drawing.look.yarns.tubeSides = 32;
    EXPECT_NEAR(heightAt(drawing.draw(straightYarn(kA, kB, Vector3f::UnitY()).view()), 160), a, 1.5);
    EXPECT_NEAR(heightAt(drawing.draw(straightYarn(kA, kB, Vector3f::UnitZ()).view()), 160), b, 1.5);
    drawing.look.yarns.tubeSides = 8;
    EXPECT_NEAR(heightAt(drawing.draw(straightYarn(kB, kB, Vector3f(0.0f, 0.8f, 0.6f)).view()), 160), b, 1.5);
}

TEST(DrawYarns, TwistTurnsThePattern)
{
    FabricDrawing drawing;
    drawing.look.occlusion = 0.0f;
    const Image straight = drawing.draw(straightYarn(0.3f, 0.3f, Vector3f::UnitY()).view());
    const Image turned = drawing.draw(straightYarn(0.3f, 0.3f, Vector3f::UnitY(), 8.0f).view());
    // Down the axis a ply goes by for every third of a turn of pitch and twist: count dark grooves.
    const auto grooves = [](const Image& image) {
        int count = 0;
        for (int x = 70; x < 250; ++x) {
            const auto at = [&](int k) { return static_cast<int>(image.color(x + k, 90).g); };
            count += at(0) < at(-3) - 4 && at(0) < at(3) - 4 && at(0) <= at(-1) && at(0) < at(1);
        }
        return count;
    };
    EXPECT_GE(grooves(straight), 4);
    EXPECT_NE(grooves(straight), grooves(turned));
    drawing.look.yarns.plies = 0.0f;
    EXPECT_EQ(grooves(drawing.draw(straightYarn(0.3f, 0.3f, Vector3f::UnitY()).view())), 0);
}

TEST(DrawYarns, ColorsFollowValuesAndMaterials)
{
    FabricDrawing drawing;
    const FakeYarns yarns = straightYarn(0.4f, 0.4f, Vector3f::UnitY());
    drawing.look.yarns.colors = {{1.0f, 0.0f, 0.0f}};
    const Rgb red = drawing.draw(yarns.view()).color(160, 85);
    EXPECT_GT(red.r, 3 * red.g);
    drawing.look.yarns.byValue = true;
    drawing.look.yarns.colorMap = ColorMap::Jet;
    const Image mapped = drawing.draw(yarns.view());
    EXPECT_GT(mapped.color(80, 85).b, 2 * mapped.color(80, 85).r) << "low: blue";
    EXPECT_GT(mapped.color(240, 85).r, 2 * mapped.color(240, 85).b) << "high: red";
}

TEST(DrawCloth, IsSeenFromBothSides)
{
    FabricDrawing drawing;
    const FlatCloth front(Vector3f::UnitX(), Vector3f::UnitY(), 0.02f), back(Vector3f::UnitY(), Vector3f::UnitX(), 0.02f);
    const double area = std::pow(2.0 * drawing.pixelsPerCm(), 2.0);
    for (const FlatCloth& cloth : {front, back}) EXPECT_NEAR(countUnlike(drawing.draw({}, cloth.view()), kWhite), area, 0.03 * area);
    EXPECT_NE(drawing.draw({}, front.view()).color(160, 90), drawing.draw({}, back.view()).color(160, 90)) << "the sides differ a little";
}

TEST(DrawCloth, HasItsThicknessEdgeOn)
{
    FabricDrawing drawing;
    const FlatCloth cloth(Vector3f::UnitX(), -Vector3f::UnitZ(), 0.3f);
    // The near edge is 1 cm before the middle.
    EXPECT_NEAR(heightAt(drawing.draw({}, cloth.view()), 160), 0.3 * drawing.pixelsPerCm() * 10.0 / 9.0, 1.5);
}

TEST(DrawCloth, ColorsFollowValues)
{
    FabricDrawing drawing;
    drawing.look.cloth.byValue = true;
    drawing.look.cloth.colorMap = ColorMap::Jet;
    const Image mapped = drawing.draw({}, FlatCloth(Vector3f::UnitX(), Vector3f::UnitY(), 0.02f).view());
    EXPECT_GT(mapped.color(140, 90).b, 2 * mapped.color(140, 90).r);
    EXPECT_GT(mapped.color(180, 90).r, 2 * mapped.color(180, 90).b);
}

TEST(DrawOcclusion, APlaneIsNotShutOffHoweverItLies)
{
    FabricDrawing drawing;
    const FlatCloth cloth(4.0f * Vector3f::UnitX(), Vector3f(0.0f, 2.0f, -3.0f), 0.01f);
    const Image shaded = drawing.draw({}, cloth.view());
    drawing.look.occlusion = 0.0f;
    const Image plain = drawing.draw({}, cloth.view());
    for (int y = 70; y < 110; ++y)
        for (int x = 100; x < 220; ++x) ASSERT_NEAR(shaded.color(x, y).g, plain.color(x, y).g, 3) << x << ", " << y;
}

TEST(DrawOcclusion, DarkensWhereAYarnLiesOnCloth)
{
    FabricDrawing drawing;
    const FlatCloth cloth(3.0f * Vector3f::UnitX(), 2.0f * Vector3f::UnitY(), 0.02f);
    FakeYarns yarns = straightYarn(0.3f, 0.3f, Vector3f::UnitY());
    for (Vector3f& x : yarns.positions) x.z() = 0.3f;
    const int beside = 90 + static_cast<int>(0.36 * drawing.pixelsPerCm()), away = 90 + static_cast<int>(1.6 * drawing.pixelsPerCm());
    const Image image = drawing.draw(yarns.view(), cloth.view());
    EXPECT_LT(image.color(160, beside).g, 0.9 * image.color(160, away).g);
}

TEST(Renderer, SolidObstaclesHideAndContainersDoNot)
{
    const CubeMesh cube(1.0f);
    FabricDrawing drawing;
    drawing.look.obstacles.style = ObstacleStyle::Solid;
    FlatCloth behind(3.0f * Vector3f::UnitX(), 2.0f * Vector3f::UnitY(), 0.02f);
    for (Vector3f& x : behind.positions) x.z() = -2.0f;
    drawing.look.cloth.colors = {{1.0f, 0.0f, 0.0f}};
    drawing.meshes = {cube.mesh(false)};
    const Rgb solid = drawing.draw({}, behind.view()).color(160, 90);
    EXPECT_NEAR(solid.r, solid.g, 20) << "grey";
    drawing.meshes = {cube.mesh(true)};
    const Rgb glass = drawing.draw({}, behind.view()).color(160, 90);
    EXPECT_GT(glass.r, 2 * glass.g) << "the cloth shows through";
}

TEST(Renderer, ColorBarsAreOfWhatIsColoredByValue)
{
    FabricDrawing drawing;
    drawing.look.overlay.colorBar = true;
    drawing.look.overlay.liquidBar = false;
    const FakeYarns yarns = straightYarn(0.1f, 0.1f, Vector3f::UnitY());
    const auto inkAtTheRight = [&] {
        const Image image = drawing.draw(yarns.view());
        int count = 0;
        for (int y = 40; y < 80; ++y)
            for (int x = 265; x < 320; ++x) count += image.color(x, y) != kWhite;
        return count;
    };
    EXPECT_EQ(inkAtTheRight(), 0);
    drawing.look.yarns.byValue = true;
    EXPECT_GT(inkAtTheRight(), 100);
}

TEST(Renderer, FramesTheFabric)
{
    FrameView view;
    const FakeYarns yarns = straightYarn(0.1f, 0.1f, Vector3f::UnitY());
    const FlatCloth cloth(Vector3f::UnitY(), 6.0f * Vector3f::UnitZ(), 0.1f);
    view.yarns = yarns.view(), view.cloth = cloth.view();
    EXPECT_TRUE(bounds(view).min().isApprox(Eigen::Vector3d(-4, -1, -6)));
    EXPECT_TRUE(bounds(view).max().isApprox(Eigen::Vector3d(4, 1, 6)));
}

TEST(Renderer, FabricWhoseSpansDisagreeIsRefused)
{
    FabricDrawing drawing;
    FakeYarns yarns = straightYarn(0.1f, 0.1f, Vector3f::UnitY());
    yarns.along.pop_back();
    EXPECT_THROW(drawing.draw(yarns.view()), std::invalid_argument);
    FlatCloth cloth(Vector3f::UnitX(), Vector3f::UnitY(), 0.02f);
    cloth.triangles[0][0] = 1000;
    EXPECT_THROW(drawing.draw({}, cloth.view()), std::invalid_argument);
}

}  // namespace
