// The whole program as a process, around the toy of fake_backends.h: TOY_PROGRAM is its file.

#include "app/frames/frame_pipeline.h"
#include "app/options.h"
#include "app/pictures/video.h"
#include "app/runs/paper_runs.h"
#include "app/system/child_process.h"
#include "sim/core/check.h"
#include "tests/app/temporary_folder.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace app {
namespace {

using nlohmann::json;
using test::contentOf;

/// A folder with the scene toy.yaml, where the program runs.
class Program : public testing::Test {
 protected:
    Program() { test::writeFile(folder / "toy.yaml", "duration: 0.03\n"); }

    ChildExit run(const std::vector<std::string>& arguments) const { return runChild(TOY_PROGRAM, arguments, {.folder = folder.path()}); }
    /// A shell script in which "$0" is the program.
    ChildExit runScript(const std::string& script) const
    {
        return runChild(*findProgram("sh"), {"-c", script, TOY_PROGRAM}, {.folder = folder.path()});
    }
    json reportOf(const std::string& run) const { return json::parse(contentOf(folder.path() / run / "report.json")); }

    test::TemporaryFolder folder;
};

void expectOneLine(const ChildExit& end, int code, const std::string& mentions)
{
    EXPECT_EQ(end.code, code) << end.errorText;
    EXPECT_EQ(std::ranges::count(end.errorText, '\n'), 1) << end.errorText;
    EXPECT_TRUE(end.errorText.starts_with("drench: ")) << end.errorText;
    EXPECT_NE(end.errorText.find(mentions), std::string::npos) << end.errorText;
}

TEST_F(Program, MistakesOnTheCommandLineExitWithTwoAndOneLine)
{
    expectOneLine(run({}), 2, "subcommand");
    expectOneLine(run({"fly", "toy.yaml"}), 2, "fly");
    expectOneLine(run({"run"}), 2, "scene");
    expectOneLine(run({"run", "toy.yaml", "--treads", "2"}), 2, "--treads");
    expectOneLine(run({"run", "toy.yaml", "--threads", "0"}), 2, "--threads");
    expectOneLine(run({"bench", "--scene", "toy.yaml", "--threads", "1,x"}), 2, "--threads");
    expectOneLine(run({"bench"}), 2, "--scene");
    expectOneLine(run({"bench", "precision", "nowhere"}), 2, "nowhere");
    expectOneLine(run({"bench", "precision", "--repeats", "0"}), 2, "--repeats");
    expectOneLine(run({"import", "nowhere.xml"}), 2, "nowhere.xml");
    expectOneLine(run({"import", "toy.yaml", "-o", "scene.yaml"}), 2, "toy.yaml:1: is no XML");
    expectOneLine(run({"import", "toy.xml", "--solver", "fast"}), 2, "--solver");
}

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

TEST_F(Program, HelpAndVersionAreNoMistakes)
{
    EXPECT_EQ(run({"--help"}).code, 0);
    EXPECT_EQ(run({"--version"}).code, 0);
    EXPECT_EQ(run({"run", "--help"}).errorText, "");
}

TEST_F(Program, RunWritesIntoTheVariantsFolder)
{
    EXPECT_TRUE(run({"run", "toy.yaml", "--variant", "b", "--threads", "3"}).ok());
    EXPECT_EQ(reportOf("out/toy/b").at("variant"), "b");
    EXPECT_EQ(reportOf("out/toy/b").at("provenance").at("threads"), 3);
    EXPECT_TRUE(run({"run", "toy.yaml", "--no-frames", "--set", "duration=0.01"}).ok());
    EXPECT_NEAR(reportOf("out/toy/default").at("simulated_time").get<double>(), 0.01, 1e-12);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/toy/default" / frameFileName(0)));
}

TEST_F(Program, RunMakesAVideoWhereThereIsFfmpeg)
{
    if (!canMakeVideos()) GTEST_SKIP() << "no ffmpeg here";
    const ChildExit end = run({"run", "toy.yaml"});
    EXPECT_TRUE(end.ok()) << end.errorText;
    EXPECT_GT(std::filesystem::file_size(folder.path() / "out/toy/default/video.mp4"), 500u);
}

TEST_F(Program, WithoutFfmpegTheRunSaysSoAndSucceeds)
{
    const test::EnvironmentVariable path("PATH", "");
    const ChildExit end = run({"run", "toy.yaml"});
    EXPECT_TRUE(end.ok());
    EXPECT_NE(end.errorText.find("no ffmpeg"), std::string::npos) << end.errorText;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/toy/default" / frameFileName(3)));
}

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

TEST_F(Program, PaperLeavesItsReportAndGoesOnWhereItWas)
{
    std::filesystem::create_directory(folder.path() / "scenes");
    for (const PaperScene& scene : paperScenes())
        std::filesystem::copy_file(folder.path() / "toy.yaml", folder.path() / "scenes" / (scene.name + ".yaml"));
    const ChildExit end = run({"paper", "--no-video"});
    ASSERT_TRUE(end.ok()) << end.errorText;
    const auto out = folder.path() / "out/paper";
    const auto table = test::linesOf(out / "table.md");
    ASSERT_EQ(table.size(), 2u + 2u * paperScenes().size());
    EXPECT_TRUE(table[2].starts_with("| dam break (small), APIC | ")) << table[2];
    EXPECT_TRUE(table.back().starts_with("| splash yarn (medium), PolyPIC | ")) << table.back();
    EXPECT_TRUE(contentOf(out / "sheet.png").starts_with("\x89PNG"));
    for (const char* plot : {"energy_dam_break.png", "energy_splash.png"})
        EXPECT_EQ(std::filesystem::exists(out / plot), findProgram("gnuplot").has_value()) << plot;

    const auto cloth = out / "splash_cloth_small/paper_apic", yarn = out / "splash_yarn_small/paper_apic";
    const std::string ofCloth = contentOf(cloth / "report.json"), ofYarn = contentOf(yarn / "report.json");
    std::filesystem::remove(yarn / frameFileName(1));
    ASSERT_TRUE(run({"paper", "--no-video"}).ok());
    EXPECT_EQ(contentOf(cloth / "report.json"), ofCloth) << "done already";
    EXPECT_NE(contentOf(yarn / "report.json"), ofYarn) << "a frame was missing";
}

/// Three runs of each: every number with its spread, and how the methods differ.
TEST_F(Program, PaperWithRepeatsTellsTheirSpread)
{
    std::filesystem::create_directory(folder.path() / "scenes");
    for (const PaperScene& scene : paperScenes())
        std::filesystem::copy_file(folder.path() / "toy.yaml", folder.path() / "scenes" / (scene.name + ".yaml"));
    const ChildExit end = run({"paper", "--no-frames", "--repeats", "3", "--out", "three"});
    ASSERT_TRUE(end.ok()) << end.errorText;
    const auto out = folder.path() / "three";
    const std::string table = contentOf(out / "table.md");
    EXPECT_NE(table.find(" ± "), std::string::npos) << table;
    std::size_t sentences = 0;
    for (std::size_t at = 0; (at = table.find("PolyPIC differs from APIC in ", at)) != std::string::npos; ++at) ++sentences;
    EXPECT_EQ(sentences, paperScenes().size()) << table;
    EXPECT_NE(table.find("| total_erg, at the end | "), std::string::npos) << table;
    const auto scene = out / "splash_cloth_small";
    EXPECT_EQ(reportOf("three/splash_cloth_small/repeats/paper_apic/002").at("status"), "done");
    EXPECT_FALSE(std::filesystem::exists(scene / "repeats/paper_apic/003"));
    EXPECT_NE(contentOf(scene / "compare.md").find("**differs**"), std::string::npos);
    EXPECT_EQ(contentOf(out / "energy_splash.gp").find("energy.csv"), std::string::npos) << "bands of all runs, no curves of one";
    EXPECT_NE(end.errorText.find(", with those to follow "), std::string::npos) << end.errorText;

    const std::string report = contentOf(scene / "repeats/paper_apic/002/report.json");
    ASSERT_TRUE(run({"paper", "--no-frames", "--repeats", "3", "--out", "three"}).ok());
    EXPECT_EQ(contentOf(scene / "repeats/paper_apic/002/report.json"), report) << "done already";
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

TEST_F(Program, BenchWritesACsvWithAHash)
{
    const ChildExit end = run({"bench", "--scene", "toy.yaml", "--threads", "1,2", "--repeats", "2", "--steps", "3", "--csv", "--machine", "m"});
    EXPECT_TRUE(end.ok()) << end.errorText;
    const auto lines = test::linesOf(folder.path() / "tests/bench/results/m/toy.csv");
    ASSERT_EQ(lines.size(), 5u) << "header and, for each number of threads, the one stage that ran and the whole step";
    // Steps 3, 4 and 5 after two warm-up ones take 3, 4 and 5 ms.
    EXPECT_TRUE(lines[1].starts_with("toy,1,pressure,4.0000,4.0000,3,2,1,4.00,")) << lines[1];
    EXPECT_TRUE(lines[4].starts_with("toy,2,step,")) << lines[4];
}

Options optionsOf(const std::vector<const char*>& words)
{
    std::vector<const char*> argv = {"drench"};
    argv.insert(argv.end(), words.begin(), words.end());
    return *readOptions(static_cast<int>(argv.size()), argv.data());
}

TEST(Options, SetTakesOneOverrideEachAndKeepsTheirOrder)
{
    const auto options = optionsOf({"run", "--set", "a=1", "--set", "b.c=[1, 2]", "scene.yaml", "--no-frames"});
    EXPECT_EQ(options.scene, "scene.yaml");
    EXPECT_EQ(options.sets, (std::vector<std::string>{"a=1", "b.c=[1, 2]"}));
    EXPECT_FALSE(options.frames);
    EXPECT_TRUE(options.video);
}

TEST(Options, TwoVariantsAreForCompareOnly)
{
    EXPECT_EQ(optionsOf({"compare", "s.yaml", "--variant", "pic", "--variant", "apic"}).variants, (std::vector<std::string>{"pic", "apic"}));
    EXPECT_THROW(optionsOf({"run", "s.yaml", "--variant", "pic", "--variant", "apic"}), sim::InputError);
}

}  // namespace
}  // namespace app
