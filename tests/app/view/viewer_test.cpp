// Needs a display: tests/CMakeLists.txt runs it under Xvfb.
#include "app/view/viewer.h"

#include "app/frames/snapshot_from_state.h"
#include "render/image.h"
#include "render/image_compare.h"
#include "tests/app/view/ui_driver.h"

#include <gtest/gtest.h>

// Pictures in the window.

namespace app::test {
namespace {

TEST(Viewer, ShowsWhatARunDraws)
{
    const Backends backends = drenchBackends();
    const LoadedScene setup = backends.loadScene(drop());
    Desktop desktop(drop(), kPaused);
    const render::Image window = desktop.shot();

    FrameSnapshot snapshot;
    const auto simulation = backends.startSimulation(setup);
    fillSnapshot(simulation->state(), simulation->fabric(), simulation->contacts(), 1.0, extrasOf(setup.pictures.render), snapshot);
    backends.meshObstacles(setup)(0.0, snapshot.obstacles);
    backends.startRenderer(setup, false)(snapshot)("run.png");
    const render::Image drawn = render::readPng("run.png");
    ASSERT_EQ(window.width, drawn.width);
    ASSERT_EQ(window.height, drawn.height);
    // Two drivers round edges differently.
    EXPECT_GT(render::structuralSimilarity(rightHalf(window), rightHalf(drawn)).mean, 0.98);
    EXPECT_LT(render::colorDifference(rightHalf(window), rightHalf(drawn)).share, 0.01);
}

TEST(Viewer, LooksAsItDidWithItsPanels)
{
    Desktop desktop(drop(), kPaused);
    desktop.expectGolden("start");
    // Panels beside the scene have text alone, which no driver draws otherwise: a label that is another one is found.
    const auto panels = [](const render::Image& window) {
        render::Image left(250, window.height);
        render::paste(window, 0, 0, left);
        return left;
    };
    const render::Image known = render::readPng(DRENCH_SOURCE_DIR "/tests/app/view/golden/start.png");
    EXPECT_TRUE(render::isWithin(render::compareImages(panels(known), panels(desktop.shot())), render::ImageTolerance{}));
}

constexpr const char* kSomeProbes =
    "output.probes={every: 1.0e-3, readings: [{name: height of the drop, unit: cm, read: liquid_y}, {name: speed, unit: cm/s, read: liquid_vy},"
    " {name: nowhere, unit: cm, read: 1/(t-t)},"
    " {name: pressure, unit: dyn/cm^2, read: \"pressure(x, y, z)\", along: {from: [0, 0, 0], to: [0, 3, 0], points: 20}}]}";

/// Without probes the right half has the scene alone.
TEST(Viewer, ProbesOfASceneHaveAPanel)
{
    SceneRequest probed = drop();
    probed.sets.emplace_back(kSomeProbes);
    const auto afterSteps = [](const SceneRequest& request, const char* golden) {
        Desktop desktop(request, kPaused);
        desktop.focus();
        desktop.keys("s s s s s s s s");
        EXPECT_TRUE(desktop.comesTrue([&] { return desktop.status().step == 8 && desktop.timeShown(0) == desktop.status().time; }));
        if (golden) desktop.expectGolden(golden);
        return rightHalf(desktop.shot());
    };
    const render::Image with = afterSteps(probed, "probes"), without = afterSteps(drop(), nullptr);
    const double panel = 0.4 * 0.48;  // of the half, at least
    EXPECT_GT(render::colorDifference(with, without).share, 0.5 * panel);
    EXPECT_LT(render::colorDifference(with, without).share, 0.5);
}

TEST(Viewer, TwoVariantsStandSideBySideAtOneTime)
{
    Desktop desktop(drop(), {.width = kWidth, .height = kHeight, .paused = true, .beside = "pic"});
    desktop.focus();
    desktop.keys("s s s s");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) == 0.02 && desktop.timeShown(1) == 0.02; }));
    desktop.expectGolden("beside");
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] {
        EXPECT_EQ(desktop.timeShown(0), desktop.timeShown(1));
        return desktop.timeShown(0) > 0.05;
    }));
    const auto& sides = desktop.viewer.pair().sides();
    EXPECT_NE(sides[0]->live.scene()->setup.scene.settings.transfer.method, sides[1]->live.scene()->setup.scene.settings.transfer.method);
}

/// Each probe has both of its readings on one line, A left and B right.
TEST(Viewer, ProbesOfTwoVariantsStandInOnePanel)
{
    SceneRequest probed = drop();
    probed.sets.emplace_back(kSomeProbes);
    Desktop desktop(probed, {.width = kWidth, .height = kHeight, .paused = true, .beside = "pic"});
    desktop.focus();
    desktop.keys("s s");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) == 0.01 && desktop.timeShown(1) == 0.01; }));
    desktop.expectGolden("beside_probes");
    desktop.keys("r");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) == 0.0 && desktop.timeShown(1) == 0.0; }));
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) >= 0.02 && desktop.timeShown(1) >= 0.02; }));
    EXPECT_EQ(desktop.status().failure, "");
}

TEST(Viewer, TinyWindowsWork)
{
    Desktop desktop(drop(), kPaused);
    desktop.shot();
    for (const char* size : {"60 40", "1 1", "5 300", "700 500"}) {
        doWithHands(std::string("search --name Drench windowsize --sync ") + size);
        for (int frame = 0; frame < 5; ++frame) desktop.viewer.frame();
    }
    const render::Image after = desktop.shot();
    EXPECT_EQ(after.width, 700);
    EXPECT_EQ(after.height, 500);
}

TEST(Viewer, EveryFrameIsRecorded)
{
    Desktop desktop(shortDrop(), kPaused);
    desktop.focus();
    desktop.viewer.record(true);
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Ended && desktop.timeShown(0) == desktop.status().time; }));
    desktop.viewer.frame();
    for (int frame = 0; frame <= 4; ++frame) {
        const std::string name = "drop_frames/frame_0000" + std::to_string(frame) + ".png";
        ASSERT_TRUE(std::filesystem::exists(name)) << name;
        EXPECT_EQ(render::readPng(name).width, kWidth);
    }
    desktop.keys("p");
    ASSERT_TRUE(desktop.comesTrue([&] { return std::filesystem::exists("drop.png"); }));
}

TEST(Viewer, WithoutADisplayItNamesTheRemedy)
{
    const char* display = std::getenv("DISPLAY");
    ASSERT_TRUE(display);
    const std::string kept = display;
    unsetenv("DISPLAY");
    try {
        Viewer viewer(drop(), drenchBackends(), kPaused);
        ADD_FAILURE() << "a window without a display";
    } catch (const sim::RunError& error) {
        EXPECT_NE(std::string(error.what()).find("drench run"), std::string::npos) << error.what();
    }
    setenv("DISPLAY", kept.c_str(), 1);
}

}  // namespace
}  // namespace app::test
