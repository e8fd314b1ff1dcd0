#include "render/visible_particles.h"

#include "tests/render/drawing.h"
#include "tests/render/fake_dam_break.h"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace render;

ViewTransforms transformsOf(const Drawing& drawing)
{
    const float zNear = 5.0f, zFar = 20.0f;
    return {viewTransform(drawing.camera).matrix().cast<float>(),
            projection(drawing.camera, static_cast<double>(drawing.look.width) / drawing.look.height, zNear, zFar).cast<float>(),
            drawing.camera.eye.cast<float>(),
            zNear,
            zFar,
            drawing.look.width,
            drawing.look.height};
}

/// A block of 15^3 particles that touch, stirred, about the origin.
void addBlock(Drawing& drawing, float spacing)
{
    std::uint32_t seed = 0;
    for (int k = 0; k < 15; ++k)
        for (int j = 0; j < 15; ++j)
            for (int i = 0; i < 15; ++i) {
                const Eigen::Vector3f stir(noise(seed + 1), noise(seed + 2), noise(seed + 3));
                seed += 3;
                drawing.add(spacing * (Eigen::Vector3f(float(i), float(j), float(k)).array() - 7.0f).matrix() + 0.4f * spacing * stir,
                            100.0f + 100.0f * stir.x());
            }
    drawing.radius = 0.62f * spacing;
}

/// Places that are nowhere, so many that the hidden ones are looked for.
void addNowhere(Drawing& drawing)
{
    const Eigen::Vector3f nowhere = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < 4096; ++i) drawing.add(nowhere, 0.0f);
}

class HiddenParticles : public testing::TestWithParam<std::tuple<int, float>> {};

TEST_P(HiddenParticles, MakeNoDifferenceToThePicture)
{
    const auto [samples, spacing] = GetParam();
    Drawing drawing;
    drawing.look.samples = samples;
    addBlock(drawing, spacing);
    drawing.add({0.0f, 0.0f, 9.99f}, 30.0f);  // about the eye
    drawing.add({3.6f, 0.0f, 0.0f}, 30.0f);   // across an edge of the picture
    const Image every = drawing.draw();
    addNowhere(drawing);
    EXPECT_TRUE(drawing.draw() == every);
}

INSTANTIATE_TEST_SUITE_P(SamplesAndSpacings, HiddenParticles,
                         testing::Combine(testing::Values(1, 2, 4, 8), testing::Values(0.06f, 0.1f, 0.2f, 0.6f)));

TEST(VisibleParticles, MostOfABlockIsHidden)
{
    Drawing drawing;
    addBlock(drawing, 0.2f);
    const std::size_t inBlock = drawing.positions.size();
    addNowhere(drawing);
    VisibleParticles visible;
    const FrameView::Liquid kept = visible.of(drawing.view().liquid, transformsOf(drawing), drawing.look.liquid, 4);
    EXPECT_LT(kept.positions.size() - 4096, inBlock / 2);
    EXPECT_EQ(kept.positions.size(), kept.values.size());
}

TEST(VisibleParticles, OneBehindAnotherIsLeftOutAndOneBesideItStays)
{
    Drawing drawing;
    drawing.add({0.0f, 0.0f, 0.5f}, 1.0f);  // in front of the next
    drawing.add({0.0f, 0.0f, -0.5f}, 2.0f);
    drawing.add({0.9f, 0.0f, -0.5f}, 3.0f);  // looks out behind the first
    drawing.add({3.0f, 0.0f, -0.5f}, 4.0f);
    addNowhere(drawing);
    VisibleParticles visible;
    const FrameView::Liquid kept = visible.of(drawing.view().liquid, transformsOf(drawing), drawing.look.liquid, 4);
    ASSERT_EQ(kept.values.size(), 4096u + 3u);
    EXPECT_EQ(kept.values[0], 1.0f);
    EXPECT_EQ(kept.values[1], 3.0f);
    EXPECT_EQ(kept.values[2], 4.0f);
}

TEST(VisibleParticles, FewAndDotsAreNotSearched)
{
    Drawing drawing;
    for (int i = 0; i < 10; ++i) drawing.add({0.0f, 0.0f, 0.0f}, 1.0f);
    VisibleParticles visible;
    EXPECT_EQ(visible.of(drawing.view().liquid, transformsOf(drawing), drawing.look.liquid, 4).positions.data(), drawing.positions.data());
    addNowhere(drawing);
    drawing.look.liquid.style = LiquidStyle::Points;
    EXPECT_EQ(visible.of(drawing.view().liquid, transformsOf(drawing), drawing.look.liquid, 4).positions.data(), drawing.positions.data());
}

}  // namespace
