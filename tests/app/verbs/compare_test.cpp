#include "app/frames/frame_pipeline.h"
#include "app/pictures/video.h"
#include "tests/app/program.h"

namespace app {
namespace {

using test::contentOf, test::Program;

TEST_F(Program, CompareLeavesEveryVariantAndItsProducts)
{
    const ChildExit end = run({"compare", "toy.yaml"});
    EXPECT_TRUE(end.ok()) << end.errorText;
    EXPECT_EQ(reportOf("out/toy/a").at("status"), "done");
    EXPECT_EQ(reportOf("out/toy/b").at("status"), "done");
    const auto out = folder.path() / "out/toy";
    EXPECT_NE(contentOf(out / "table.md").find("| B\\|2 |"), std::string::npos);
    EXPECT_EQ(test::linesOf(out / "energy.csv").size(), 1u + 2u * 10u);
    EXPECT_TRUE(test::contentOf(out / "sheet.png").starts_with("\x89PNG"));
    EXPECT_EQ(std::filesystem::exists(out / "energy.png"), findProgram("gnuplot").has_value());
    EXPECT_EQ(std::filesystem::exists(out / "compare.mp4"), canMakeVideos());
}

TEST_F(Program, CompareRunsOnlyWhatIsMissing)
{
    ASSERT_TRUE(run({"compare", "toy.yaml", "--no-video"}).ok());
    const std::string a = contentOf(folder.path() / "out/toy/a/report.json"), b = contentOf(folder.path() / "out/toy/b/report.json");
    std::filesystem::remove(folder.path() / "out/toy/b" / frameFileName(1));
    ASSERT_TRUE(run({"compare", "toy.yaml", "--no-video"}).ok());
    EXPECT_EQ(contentOf(folder.path() / "out/toy/a/report.json"), a) << "done already";
    EXPECT_NE(contentOf(folder.path() / "out/toy/b/report.json"), b) << "a frame was missing";

    ASSERT_TRUE(run({"compare", "toy.yaml", "--no-video", "--set", "speed=3"}).ok());
    EXPECT_NE(contentOf(folder.path() / "out/toy/a/report.json"), a) << "another scene";
    const std::string again = contentOf(folder.path() / "out/toy/a/report.json");
    ASSERT_TRUE(run({"compare", "toy.yaml", "--no-video", "--set", "speed=3", "--force"}).ok());
    EXPECT_NE(contentOf(folder.path() / "out/toy/a/report.json"), again) << "--force";
}

TEST_F(Program, CompareOrRunRunsTheOneVariantAskedFor)
{
    ASSERT_TRUE(run({"compare", "toy.yaml", "--or-run", "--variant", "b"}).ok());
    EXPECT_EQ(reportOf("out/toy/b").at("status"), "done");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/toy/table.md"));
}

TEST_F(Program, CompareGoesOnAfterAVariantThatFails)
{
    ASSERT_TRUE(run({"compare", "toy.yaml", "--no-video", "--variant", "a"}).ok());
    std::filesystem::remove_all(folder.path() / "out/toy/b");
    // A file where b wants its folder.
    test::writeFile(folder.path() / "out/toy/b", "in the way");
    const ChildExit end = run({"compare", "toy.yaml", "--no-video"});
    EXPECT_EQ(end.code, 1);
    EXPECT_EQ(end.lastWords(), "drench: 1 of 2 variants did not get to their end");
    EXPECT_NE(contentOf(folder.path() / "out/toy/table.md").find("| A |"), std::string::npos);
}

}  // namespace
}  // namespace app
