// What is made of a run afterwards, by the program itself.
#include "tests/app/checkpoint/small_scene.h"

#include "app/checkpoint/state_files.h"

#include <algorithm>

namespace app::test {
namespace {

class StoredRuns : public testing::Test, protected SmallRuns {
 protected:
    ChildExit render(const std::string& run, std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(), {"render", run, "--no-video", "--threads", "1"});
        return drench(more);
    }
    void expectRefused(const ChildExit& end, const std::string& mentions) const
    {
        EXPECT_EQ(end.code, 2) << end.errorText;
        EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
        EXPECT_NE(end.errorText.find(mentions), std::string::npos) << end.errorText;
    }
    std::string picture(const std::string& run, int frame) const
    {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%05d.png", frame);
        return contentOf(folder / run / name);
    }
};

/// From states that hold no more of the liquid than its velocity, and from whole ones.
TEST_F(StoredRuns, PicturesMadeAnewAreThoseOfTheRun)
{
    ASSERT_EQ(run("run").code, 0);
    ASSERT_EQ(render("run").code, 0);
    expectSameFiles("run", "run", 0);
    for (int n = 0; n <= 20; ++n) EXPECT_TRUE(picture("run/pictures", n) == picture("run", n)) << n;
    std::filesystem::remove_all(folder / "run" / "states");
    ASSERT_EQ(render("run", {"--out", "again"}).code, 0);
    for (int n = 0; n <= 20; ++n) EXPECT_TRUE(picture("again", n) == (n > 0 && n % 2 == 0 ? picture("run", n) : "")) << n;
}

TEST_F(StoredRuns, PicturesMadeAnewCanLookOtherwise)
{
    ASSERT_EQ(run("run").code, 0);
    const std::vector<std::string> look = {"--set", "render.size=[80, 60]",         "--set", "render.liquid.color_by=pressure",
                                           "--set", "render.liquid.range=[0, 500]", "--set", "render.cloth.color_by=saturation"};
    ASSERT_EQ(render("run", look).code, 0);
    std::vector<std::string> sets = look;
    ASSERT_EQ(run("otherwise", sets).code, 0);
    for (int n = 0; n <= 20; n += 5) EXPECT_TRUE(picture("run/pictures", n) == picture("otherwise", n)) << n;
    ASSERT_EQ(render("run", {"--set", "render.background=[0, 0, 0]"}).code, 0) << "over those of before";
    EXPECT_FALSE(picture("run/pictures", 5) == picture("otherwise", 5));
}

TEST_F(StoredRuns, WhatCannotBeDrawnAnewIsRefused)
{
    ASSERT_EQ(run("run", {"--set", "output.data=[energy]"}).code, 0);
    expectRefused(render("run"), "output.data: [states]");
    expectRefused(render("nowhere"), "no folder of a run");
    ASSERT_EQ(run("run").code, 0);
    expectRefused(render("run", {"--set", "gravity=[0, 0, 0]"}), "only render and output");
    expectRefused(render("run", {"--set", "render.sise=[80, 60]"}), "sise");
    expectRefused(render("run", {"--out", "run"}), "choose another folder");
    const std::filesystem::path state = stateFile(folder / "run", StateKind::ForPictures, 3);
    writeFile(state, contentOf(state).substr(0, 3000));
    const ChildExit end = render("run");
    EXPECT_EQ(end.code, 2);
    EXPECT_NE(end.lastWords().find("state_00003.h5: the checkpoint is cut off"), std::string::npos) << end.errorText;
}

TEST_F(StoredRuns, StandSideBySide)
{
    ASSERT_EQ(run("run").code, 0);
    ASSERT_EQ(render("run", {"--panel", "--out", "a"}).code, 0);
    ASSERT_EQ(render("run", {"--panel", "--out", "b", "--set", "render.background=[0, 0, 0]"}).code, 0);
    const ChildExit end = drench({"compare", "--from", "a", "--from", "b", "--out", "both", "--set", "compare.products=[table, sheet]"});
    ASSERT_EQ(end.code, 0) << end.errorText;
    EXPECT_GT(contentOf(folder / "both" / "sheet.png").size(), 1000u);
    EXPECT_NE(contentOf(folder / "both" / "table.md").find("| a | b |"), std::string::npos) << contentOf(folder / "both" / "table.md");
    expectRefused(drench({"compare", "--from", "a", "--from", "small.yaml", "--out", "both"}), "small.yaml: this is no folder of a run");
    expectRefused(drench({"compare", "--from", "a"}), "--out");
    expectRefused(drench({"compare", "small.yaml", "--from", "a", "--out", "both"}), "either scene or --from");
}

}  // namespace
}  // namespace app::test
