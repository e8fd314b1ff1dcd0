#include "app/frames/frame_pipeline.h"
#include "app/runs/paper_runs.h"
#include "tests/app/program.h"

namespace app {
namespace {

using test::contentOf, test::Program;

TEST_F(Program, PaperLeavesItsReportAndGoesOnWhereItWas)
{
    std::filesystem::create_directory(folder.path() / "scenes");
    for (const PaperScene& scene : paperScenes())
        std::filesystem::copy_file(folder.path() / "toy.yaml", folder.path() / "scenes" / (scene.name + ".yaml"));
    const ChildExit end = run({"paper", "--no-video"});
    ASSERT_TRUE(end.ok()) << end.errorText;
    const auto out = folder.path() / "out/paper";
    const auto table = test::linesOf(out / "table.md");
    ASSERT_EQ(table.size(), 4u + 2u * paperScenes().size());
    EXPECT_TRUE(table[4].starts_with("| dam break (small), APIC | ")) << table[4];
    EXPECT_TRUE(table.back().starts_with("| splash yarn (medium), PolyPIC | ")) << table.back();
    EXPECT_TRUE(contentOf(out / "sheet.png").starts_with("\x89PNG"));
    for (const char* plot : {"energy_dam_break.png", "energy_splash.png"})
        EXPECT_EQ(std::filesystem::exists(out / plot), findProgram("gnuplot").has_value()) << plot;
    if (findProgram("gnuplot")) {
        const std::string script = contentOf(out / "energy_splash.gp");
        for (const char* polypic : {"$difference_1 ", "$difference_3 ", "$difference_5 "})
            EXPECT_NE(script.find(polypic), std::string::npos) << polypic << " to APIC of its scene: " << script;
    }

    const auto cloth = out / "splash_cloth_small/paper_apic", yarn = out / "splash_yarn_small/paper_apic";
    const std::string ofCloth = contentOf(cloth / "report.json"), ofYarn = contentOf(yarn / "report.json");
    std::filesystem::remove(yarn / frameFileName(1));
    ASSERT_TRUE(run({"paper", "--no-video"}).ok());
    EXPECT_EQ(contentOf(cloth / "report.json"), ofCloth) << "done already";
    EXPECT_NE(contentOf(yarn / "report.json"), ofYarn) << "a frame was missing";
}

TEST(PaperSheet, NamesSceneAndMethodOfEachPicture)
{
    const test::TemporaryFolder folder;
    ComparedRun apic, polypic;
    apic.setup.variant = "paper_apic";
    polypic.setup.variant = "paper_polypic";
    apic.folder = polypic.folder = folder.path();
    const OverviewRow row = overviewRow({paperScenes()[1], {}, {apic, polypic}, {}});
    ASSERT_EQ(row.sequences.size(), 2u);
    EXPECT_EQ(row.sequences[0].label, "splash cloth (small), APIC");
    EXPECT_EQ(row.sequences[1].label, "splash cloth (small), PolyPIC");
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
    EXPECT_NE(table.find("| s_per_step, median | "), std::string::npos) << table;
    EXPECT_NE(table.find("| peak_memory_mb | "), std::string::npos) << "what the paper says of memory: " << table;
    EXPECT_NE(table.find("Means ± standard deviations of 3 runs each"), std::string::npos) << table;
    const auto scene = out / "splash_cloth_small";
    EXPECT_EQ(reportOf("three/splash_cloth_small/repeats/paper_apic/002").at("status"), "done");
    EXPECT_FALSE(std::filesystem::exists(scene / "repeats/paper_apic/003"));
    EXPECT_NE(contentOf(scene / "compare.md").find("**differs**"), std::string::npos);
    EXPECT_EQ(contentOf(out / "energy_splash.gp").find("energy.csv"), std::string::npos) << "bands of all runs, no curves of one";
    if (findProgram("gnuplot")) {
        const std::string script = contentOf(out / "energy_splash.gp"), panel = "set title 'total, less that of the first method' noenhanced\n";
        EXPECT_NE(script.find(panel + "set ylabel '[% of the largest total]'"), std::string::npos) << script;
    }
    EXPECT_NE(end.errorText.find(", with those to follow "), std::string::npos) << end.errorText;

    const std::string report = contentOf(scene / "repeats/paper_apic/002/report.json");
    ASSERT_TRUE(run({"paper", "--no-frames", "--repeats", "3", "--out", "three"}).ok());
    EXPECT_EQ(contentOf(scene / "repeats/paper_apic/002/report.json"), report) << "done already";
}

}  // namespace
}  // namespace app
