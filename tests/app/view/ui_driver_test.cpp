// Needs a display: tests/CMakeLists.txt runs it under Xvfb.
#include "app/view/viewer.h"

#include "app/system/atomic_files.h"
#include "render/image_compare.h"
#include "tests/app/view/ui_driver.h"
#include "tests/app/view/xdnd_file.h"

#include <gtest/gtest.h>

// What somebody at the keyboard and the mouse does.

namespace app::test {
namespace {

TEST(Hands, KeysPlayPauseStepAndRestart)
{
    Desktop desktop(drop(), kPaused);
    desktop.focus();
    desktop.keys("s");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().step == 1; }));
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Playing && desktop.status().step > 3; }));
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Paused; }));
    desktop.keys("r");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().step == 0; }));
}

TEST(Hands, TheMouseTurnsTheView)
{
    Desktop desktop(drop(), kPaused);
    const render::Image before = desktop.shot();
    doWithHands("mousemove 700 300");
    desktop.viewer.frame();
    doWithHands("mousedown 1");
    desktop.viewer.frame();
    doWithHands("mousemove 800 300");
    desktop.viewer.frame();
    doWithHands("mouseup 1");
    EXPECT_GT(render::colorDifference(rightHalf(before), rightHalf(desktop.shot())).share, 0.1);
    desktop.focus();
    desktop.keys("c");
    EXPECT_LT(render::colorDifference(rightHalf(before), rightHalf(desktop.shot())).share, 1e-3) << "as the scene's file has it";
}

TEST(Hands, ASettingIsChangedInItsField)
{
    Desktop desktop(drop(), kPaused);
    desktop.focus();
    desktop.keys("s s s");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().step == 3; }));
    desktop.enter("time.dt", "0.0005");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.valueOf("time.dt") == "0.0005"; }));
    EXPECT_EQ(desktop.status().step, 3) << "keys that are typed into a field do nothing else";
    desktop.enter("time.dt", "2 ms");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.valueOf("time.dt") == "0.002"; }));
    desktop.enter("time.dt", "-1");
    ASSERT_TRUE(desktop.comesTrue([&] { return !desktop.status().refused.empty(); }));
    EXPECT_EQ(desktop.status().refused, "--set time.dt=-1 s: time.dt: \"-1 s\" is out of range; must be above 0 s");
    EXPECT_EQ(desktop.valueOf("time.dt"), "0.002");
    EXPECT_EQ(desktop.viewer.pair().first().scene()->setup.scene.changes.size(), 1u);
}

TEST(Hands, WhatIsSavedRunsToTheSameState)
{
    Desktop desktop(shortDrop(), kPaused);
    desktop.focus();
    desktop.keys("s s s");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().step == 3; }));
    desktop.enter("time.dt", "0.0005");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.valueOf("time.dt") == "0.0005"; }));
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Ended; }));
    LiveSimulation& live = desktop.viewer.pair().first();
    const std::uint64_t hash = live.stateHash();
    desktop.keys("ctrl+s");
    ASSERT_TRUE(desktop.comesTrue([&] { return std::filesystem::exists("drop_live.yaml"); }));
    EXPECT_EQ(desktop.viewer.message(), "saved as drop_live.yaml");
    EXPECT_EQ(hashOfRun("drop_live.yaml"), hash);

    live.goBackTo(0.011);
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Paused; }));
    EXPECT_EQ(desktop.status().time, 0.01);
    desktop.keys("space");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().mode == LiveMode::Ended; }));
    EXPECT_EQ(live.stateHash(), hash) << "back, and on as before";
    desktop.keys("ctrl+s");
    ASSERT_TRUE(desktop.comesTrue([&] { return std::filesystem::exists("drop_live_2.yaml"); })) << "nothing is overwritten";
}

TEST(Hands, AFileThatIsDroppedOntoTheWindowIsOpened)
{
    Desktop desktop(drop(), kPaused);
    desktop.shot();
    writeWhole("a scene.yaml", readWhole(DRENCH_SOURCE_DIR "/scenes/drop.yaml"));
    DraggedFile file("a scene.yaml", "A drop falls into a pool - Drench");
    ASSERT_TRUE(desktop.comesTrue([&] { return file.isTaken(); }));
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) == 0.0; }));
    EXPECT_EQ(desktop.viewer.pair().first().scene()->request.file, std::filesystem::absolute("a scene.yaml"));
}

TEST(Hands, AnotherSceneIsOpenedAndABadOneIsNot)
{
    Desktop desktop(drop(), kPaused);
    desktop.shot();
    writeWhole("bad.yaml", "grid: {cell: 0.1, sell: 3}\n");
    desktop.viewer.open("bad.yaml");
    desktop.viewer.frame();
    EXPECT_EQ(desktop.viewer.message(), "bad.yaml:1: unknown key \"sell\" in grid (did you mean \"cell\"?)");
    EXPECT_EQ(desktop.viewer.pair().first().scene()->setup.scene.name, "drop") << "the one before stays";
    writeWhole("other.yaml", readWhole(DRENCH_SOURCE_DIR "/scenes/drop.yaml"));
    desktop.viewer.open("other.yaml");
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.timeShown(0) == 0.0; }));
    EXPECT_EQ(desktop.viewer.pair().first().scene()->request.file, "other.yaml");
}

TEST(Hands, ClosedAmidAStepItEnds)
{
    Desktop desktop(drop(), {.width = kWidth, .height = kHeight});
    ASSERT_TRUE(desktop.comesTrue([&] { return desktop.status().step > 2; }));
    desktop.focus();
    doWithHands("key ctrl+q");
    bool isClosed = false;
    EXPECT_TRUE(desktop.comesTrue([&] { return isClosed = isClosed || !desktop.viewer.frame(); }));
    EXPECT_EQ(desktop.status().mode, LiveMode::Playing);
}

}  // namespace
}  // namespace app::test
