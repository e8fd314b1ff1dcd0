// Needs a display: tests/CMakeLists.txt runs it under Xvfb.
#include "app/view/window.h"

#include "render/draw_targets.h"
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace app::test {
namespace {

using render::Image;

constexpr int kWidth = 800, kHeight = 400;

/// A window, and a ball of liquid to be drawn into parts of it.
struct Parted {
    Parted()
    {
        window.begin();
        camera.eye = {0.0, 0.0, 6.0};
        look.overlay.label = "left";
    }
    render::FrameView view() const { return {0.25, {positions, values, 0.8f}, {}}; }
    void show(const render::Viewport& part) { renderer.show(view(), camera, look, part); }
    Image drawn(int width, int height)
    {
        render::Look fitted = look;
        fitted.width = width, fitted.height = height;
        return renderer.draw(view(), camera, fitted);
    }
    Image shown() { return render::readFramebuffer(window.context().gl(), 0, window.width(), window.height()); }

    Window window{"Parts", kWidth, kHeight};
    render::Renderer renderer{window.context()};
    std::vector<Eigen::Vector3f> positions = {{-0.5f, 0.0f, 0.0f}, {0.5f, 0.3f, 0.0f}};
    std::vector<float> values = {50.0f, 150.0f};
    render::Camera camera;
    render::Look look;
};

/// Largest difference of a channel between `part`, counted from the top left corner (x, y) of `whole`, and the latter.
int largestDifference(const Image& whole, int x, int y, const Image& part)
{
    int largest = 0;
    for (int j = 0; j < part.height; ++j)
        for (int i = 0; i < part.width; ++i)
            for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(whole.at(x + i, y + j)[c] - part.at(i, j)[c]));
    return largest;
}

/// Two pictures side by side are the two pictures, letters, times and bars in their places. Steps of 255 are what rounding makes of letters and their
/// rims: in a picture after each of them, in the window after both, and again.
TEST(Window, HoldsPicturesSideBySide)
{
    Parted p;
    ASSERT_EQ(p.window.width(), kWidth);
    p.show({.x = 0, .y = 0, .width = kWidth / 2, .height = kHeight});
    const Image left = p.drawn(kWidth / 2, kHeight);
    p.look.overlay.label = "right";
    p.look.background = {0.1f, 0.1f, 0.2f};
    p.positions.pop_back();
    p.values.pop_back();
    p.show({.x = kWidth / 2, .y = 0, .width = kWidth / 2, .height = kHeight});
    const Image right = p.drawn(kWidth / 2, kHeight), both = p.shown();
    if (const char* keep = std::getenv("DRENCH_KEEP_PARTS")) render::writePng(both, keep);
    EXPECT_LE(largestDifference(both, 0, 0, left), 2);
    EXPECT_LE(largestDifference(both, kWidth / 2, 0, right), 2);
    EXPECT_GT(largestDifference(both, 0, 0, right), 100);
    EXPECT_TRUE(p.window.context().takeGlMessages().empty());
}

TEST(Window, KeepsWhatIsBesideAPart)
{
    Parted p;
    p.show({.x = 0, .y = 0, .width = kWidth, .height = kHeight});
    const Image before = p.shown();
    p.look.background = {1.0f, 0.0f, 0.0f};
    p.show({.x = 30, .y = 40, .width = 200, .height = 100});
    Image after = p.shown();
    EXPECT_LE(largestDifference(after, 30, kHeight - 140, p.drawn(200, 100)), 1);
    Image expected = before;
    render::paste(p.drawn(200, 100), 30, kHeight - 140, expected);
    EXPECT_LE(largestDifference(after, 0, 0, expected), 1);
}

/// What is asked of OpenGL and makes no sense is told, once.
TEST(Window, ReportsErrorsOfOpenGl)
{
    Parted p;
    EXPECT_TRUE(p.window.context().takeGlMessages().empty());
    p.window.context().gl().Enable(0x1);
    const std::vector<std::string> complaints = p.window.context().takeGlMessages();
    ASSERT_EQ(complaints.size(), 1u);
    EXPECT_NE(complaints[0], "");
    EXPECT_TRUE(p.window.context().takeGlMessages().empty());
    EXPECT_EQ(p.window.context().gl().GetError(), static_cast<GLenum>(GL_INVALID_ENUM)) << "and is cleared";
}

}  // namespace
}  // namespace app::test
