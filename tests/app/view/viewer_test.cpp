// Needs a display: tests/CMakeLists.txt runs it under Xvfb.
#include "app/view/viewer.h"

#include "app/frame_view_from_state.h"
#include "render/image.h"
#include "render/image_compare.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace app::test {
namespace {

constexpr int kWidth = 900, kHeight = 600;

SceneSetup drop()
{
    return drenchParts().loadScene({.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml",
                                    .variant = "",
                                    .sets = {"render.size=[900, 600]"}});
}

/// A frame that OpenGL has nothing to complain about.
bool frame(Viewer& viewer)
{
    const bool goesOn = viewer.frame();
    for (const std::string& complaint : viewer.takeComplaints()) ADD_FAILURE() << complaint;
    return goesOn;
}

/// The frame after those in which the window has come up.
render::Image shot(Viewer& viewer)
{
    const TemporaryFolder folder;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(frame(viewer));
    viewer.screenshot(folder / "window.png");
    frame(viewer);
    return render::readPng(folder / "window.png");
}

/// The right half, where there is no panel.
render::Image rightHalf(const render::Image& image)
{
    render::Image half(image.width / 2, image.height);
    for (int y = 0; y < image.height; ++y)
        std::copy_n(image.at(image.width - half.width, y), 3 * half.width, half.at(0, y));
    return half;
}

TEST(Viewer, ShowsWhatARunDraws)
{
    const SceneSetup setup = drop();
    const Parts parts = drenchParts();
    Viewer viewer(setup, parts, {.width = kWidth, .height = kHeight, .paused = true});
    const render::Image window = shot(viewer);
    if (const char* keep = std::getenv("DRENCH_KEEP_SCREENSHOT")) render::writePng(window, keep);

    const TemporaryFolder folder;
    const auto simulation = parts.startSimulation(setup);
    FrameSnapshot snapshot;
    takeSnapshot(simulation->state(), simulation->fabric(), simulation->contacts(), 1.0, extrasOf(setup.pictures.render), snapshot);
    parts.meshObstacles(setup)(0.0, snapshot.obstacles);
    parts.startRenderer(setup, false)(snapshot)(folder / "run.png");
    const render::Image drawn = render::readPng(folder / "run.png");
    ASSERT_EQ(window.width, drawn.width);
    ASSERT_EQ(window.height, drawn.height);
    // Two drivers round edges differently.
    EXPECT_GT(render::structuralSimilarity(rightHalf(window), rightHalf(drawn)).mean, 0.98);
    EXPECT_LT(render::meanColorDifference(rightHalf(window), rightHalf(drawn)), 2.0 / 255.0);
}

/// As somebody at the keyboard and the mouse would.
void doWithHands(const std::string& what)
{
    ASSERT_EQ(std::system(("xdotool " + what).c_str()), 0) << what;
}

/// Frames until it is true, for as long as any machine may take.
template <class F>
bool comesTrue(Viewer& viewer, F&& isTrue)
{
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!isTrue()) {
        if (std::chrono::steady_clock::now() > end) return false;
        frame(viewer);
    }
    return true;
}

TEST(Viewer, KeysPlayPauseStepAndRestart)
{
    Viewer viewer(drop(), drenchParts(), {.width = kWidth, .height = kHeight, .paused = true});
    shot(viewer);
    doWithHands("search --name Drench windowfocus");  // there is no window manager to do it
    frame(viewer);
    doWithHands("key s");
    ASSERT_TRUE(comesTrue(viewer, [&] { return viewer.status().step == 1; }));
    doWithHands("key space");
    ASSERT_TRUE(
        comesTrue(viewer, [&] { return viewer.status().mode == LiveMode::Playing && viewer.status().step > 3; }));
    doWithHands("key space");
    ASSERT_TRUE(comesTrue(viewer, [&] { return viewer.status().mode == LiveMode::Paused; }));
    doWithHands("key r");
    ASSERT_TRUE(comesTrue(viewer, [&] { return viewer.status().step == 0; }));
}

TEST(Viewer, TheMouseTurnsTheView)
{
    Viewer viewer(drop(), drenchParts(), {.width = kWidth, .height = kHeight, .paused = true});
    const render::Image before = shot(viewer);
    doWithHands("mousemove 700 300");
    frame(viewer);
    doWithHands("mousedown 1");
    frame(viewer);
    doWithHands("mousemove 800 300");
    frame(viewer);
    doWithHands("mouseup 1");
    const render::Image after = shot(viewer);
    EXPECT_GT(render::meanColorDifference(rightHalf(before), rightHalf(after)), 1.0 / 255.0);
}

/// What is looked at is what a run without a window computes, to the last bit, and so is what follows after going back.
TEST(LiveScene, EndsAsARunDoes)
{
    const SceneSetup setup = drenchParts().loadScene({.file = DRENCH_SOURCE_DIR "/scenes/drop.yaml",
                                                      .variant = "",
                                                      .sets = {"time.duration=0.02", "output.every=0.005"}});
    const auto run = drenchParts().startSimulation(setup);
    for (std::int64_t frame = 1; frame <= frameCount(setup); ++frame)
        while (run->state().time < frameTime(setup, frame)) run->step(frameTime(setup, frame));

    LiveSimulation live(setup, drenchParts());
    const auto ends = [&] {
        live.play();
        while (live.status().mode != LiveMode::Ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return live.stateHash();
    };
    EXPECT_EQ(ends(), run->stateHash());
    live.goBackTo(0.011);
    while (live.status().mode == LiveMode::Ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(live.status().time, 0.01);
    EXPECT_EQ(ends(), run->stateHash());
}

}  // namespace
}  // namespace app::test
