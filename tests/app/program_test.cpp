#include "tests/app/program.h"
#include "app/frames/frame_pipeline.h"

namespace app {
namespace {

using nlohmann::json;
using test::contentOf, test::expectOneLine, test::Program;

TEST_F(Program, MistakesInASceneExitWithTwoAndOneLine)
{
    expectOneLine(run({"run", "nowhere.yaml"}), 2, "nowhere.yaml");
    expectOneLine(run({"run", "toy.yaml", "--set", "viscocity=3"}), 2, "viscocity");
    expectOneLine(run({"compare", "toy.yaml", "--variant", "z"}), 2, "it has a, b");
    EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "nothing is begun for a scene that cannot be read";
}

TEST_F(Program, AWindowThatCannotBeOpenedExitsWithOneLine)
{
    expectOneLine(run({"view", "nowhere.yaml"}), 2, "nowhere.yaml");
    expectOneLine(run({"view", "toy.yaml"}), 1, "drench run");  // the toy has none
}

TEST_F(Program, AnOutThatIsAFileExitsWithTwo)
{
    expectOneLine(run({"run", "toy.yaml", "--out", "toy.yaml"}), 2, "is a file");
    EXPECT_EQ(contentOf(folder / "toy.yaml"), "duration: 0.03\n");
}

TEST_F(Program, ARunThatCannotGoOnExitsWithOne)
{
    const ChildExit end = run({"run", "toy.yaml", "--set", "fail_at_step=3"});
    EXPECT_EQ(end.code, 1);
    EXPECT_EQ(end.lastWords(), "drench: toy.yaml: step 3, pressure: the toy fell over");
}

const std::string kInterrupted = " & while [ ! -s \"$out/steps.jsonl\" ]; do sleep 0.01; done; kill -INT $!; wait $!";

TEST_F(Program, InterruptLeavesAValidFolder)
{
    const ChildExit end = runScript("out=here; \"$0\" run toy.yaml --out here --set duration=100 --set step_ms=5" + kInterrupted);
    EXPECT_EQ(end.code, 1) << end.errorText;
    const json report = reportOf("here");
    EXPECT_EQ(report.at("status"), "interrupted");
    EXPECT_GE(report.at("frames"), 1);
    EXPECT_LT(report.at("frames"), 1000);
    const auto frames = report.at("frames").get<int>();
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "here" / frameFileName(frames)));
    for (const auto& line : test::linesOf(folder.path() / "here/steps.jsonl")) EXPECT_TRUE(json::accept(line)) << line;
}

TEST_F(Program, InterruptOfACompareReachesTheVariantAndStartsNoOther)
{
    const ChildExit end = runScript("out=here/a; \"$0\" compare toy.yaml --out here --set duration=100 --set step_ms=5" + kInterrupted);
    EXPECT_EQ(end.code, 1) << end.errorText;
    EXPECT_EQ(reportOf("here/a").at("status"), "interrupted");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "here/b"));
}

}  // namespace
}  // namespace app
