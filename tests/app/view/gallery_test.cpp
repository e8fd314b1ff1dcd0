// Needs a display: tests/CMakeLists.txt runs it under Xvfb.
#include "tests/app/view/ui_driver.h"

#include <gtest/gtest.h>

// The pictures of the window in the README: DRENCH_KEEP_SCREENSHOTS names the folder they go to, scenes/gallery.

namespace app::test {
namespace {

const ViewOptions kWide = {.width = 1200, .height = 700, .paused = true};

SceneRequest wideDrop() { return {.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml", .variant = "", .sets = {"time.dt=2 ms", "render.hud=true"}}; }

void playTo(Desktop& desktop, double time)
{
    desktop.focus();
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) >= time; }));
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Paused; }));
}

void keep(Desktop& desktop, const std::string& name)
{
    const render::Image shot = desktop.shot();
    if (const char* folder = std::getenv("DRENCH_KEEP_SCREENSHOTS")) render::writePng(shot, std::filesystem::path(folder) / (name + ".png"));
}

TEST(Gallery, AWindow)
{
    Desktop desktop(wideDrop(), kWide);
    playTo(desktop, 0.08);
    EXPECT_EQ(desktop.status().failure, "");
    keep(desktop, "view");
}

TEST(Gallery, SettingsThatChangedAndOneThatWaits)
{
    Desktop desktop(wideDrop(), kWide);
    playTo(desktop, 0.04);
    desktop.enter("time.dt", "0.001");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.valueOf("time.dt") == "0.001"; }));
    desktop.enter("time.duration", "0.5");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.viewer.pair().first().scene()->waiting.size() == 1u; }));
    EXPECT_EQ(desktop.valueOf("time.duration"), "0.2") << "until it is restarted";
    desktop.enter("time.cfl", "-3");
    ASSERT_TRUE(desktop.comesTrue([&] { return !desktop.status().refused.empty(); }));
    keep(desktop, "view_settings");
}

TEST(Gallery, TwoSideBySide)
{
    ViewOptions options = kWide;
    options.beside = "pic";
    SceneRequest request = wideDrop();
    request.variant = "polypic";
    Desktop desktop(request, options);
    playTo(desktop, 0.1);
    EXPECT_EQ(desktop.timeShown(0), desktop.timeShown(1));
    keep(desktop, "view_beside");
}

}  // namespace
}  // namespace app::test
