#include "app/reports/compare_table.h"
#include "app/reports/energy_plot.h"
#include "app/reports/step_logs.h"
#include "app/system/csv.h"
#include "app/system/gnuplot.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using test::TemporaryFolder;

RunResult resultOf(const std::string& label, double secondsPerStep)
{
    RunResult run;
    run.label = label;
    run.stateHash = "00ff";
    run.steps = 250;
    run.particles = 313501;
    run.simulatedTime = 0.05;
    run.wallSeconds = 372.0;
    run.secondsPerStep = secondsPerStep;
    run.peakMemoryMegabytes = 411.6;
    run.meanIterations = 7.25;
    run.maxIterations = 12;
    run.stageSeconds[static_cast<int>(sim::Stage::Pressure)] = 0.0125;
    return run;
}

TEST(CompareTable, HasARowPerVariantAndAColumnPerStage)
{
    const std::string table = compareTable("Dam break", {resultOf("APIC", 0.02), resultOf("PolyPIC | 8", 0.03)}, "APIC");
    EXPECT_TRUE(table.starts_with("# Dam break\n\n| variant | s/step (median) | × APIC | steps |")) << table;
    EXPECT_NE(table.find("| APIC | 0.0200 | 1.00 | 250 | 0.05 | 6 m 12 s | 412 | 313501 | 7.2 | 12 | `00ff` |\n"), std::string::npos) << table;
    EXPECT_NE(table.find("| PolyPIC \\| 8 | 0.0300 | 1.50 |"), std::string::npos) << "a bar in a label must not split its cell";
    EXPECT_NE(table.find("| pressure | 12.500 | 12.500 |\n"), std::string::npos) << table;
    EXPECT_EQ(table.find("| relax |"), std::string::npos) << "a stage that never ran";
}

TEST(CompareTable, MarksWhereAStageThatOthersHaveDidNotRun)
{
    RunResult relaxed = resultOf("APIC", 0.02);
    relaxed.stageSeconds[static_cast<int>(sim::Stage::Relax)] = 0.002;
    const std::string table = compareTable("T", {relaxed, resultOf("PolyPIC", 0.03)}, "");
    EXPECT_NE(table.find("| relax | 2.000 | - |\n"), std::string::npos) << table;
}

TEST(CompareTable, WithoutReferenceThereIsNoRatio) { EXPECT_EQ(compareTable("T", {resultOf("APIC", 0.02)}, "").find("×"), std::string::npos); }

const std::string kEnergies =
    "time_s,kinetic_erg,modal_erg,potential_erg,total_erg,particles,liquid_mass_g\n"
    "0,0,0,3.6e6,3.6e6,10,2\n0.1,1e6,1e4,2.5e6,3.51e6,10,2\n0.2,1.5e6,1e4,1.9e6,3.41e6,10,2\n";

TEST(CompareTable, SaysInOneSentenceWhatKeptMostAndHowLongItTook)
{
    EXPECT_EQ(outcomeSentence({{"PIC", 0.742, 62.0}, {"Best", 0.971, 38.0}, {"APIC", 0.9, 3600.0}}),
              "Energy kept and time taken: Best 97.1 % in 38 s, APIC 90.0 % in 1 h 00 m, PIC 74.2 % in 1 m 02 s.");
    EXPECT_EQ(outcomeSentence({}), "");
}

TEST(EnergyPlot, JoinsAllVariantsIntoOneTable)
{
    TemporaryFolder folder;
    test::writeFile(folder / "a.csv", kEnergies);
    test::writeFile(folder / "b.csv", kEnergies);
    joinEnergies({{"pic", "PIC", folder / "a.csv"}, {"apic", "APIC", folder / "b.csv"}}, folder / "energy.csv");
    const auto lines = test::linesOf(folder / "energy.csv");
    ASSERT_EQ(lines.size(), 7u);
    EXPECT_TRUE(lines[0].starts_with("variant,time_s,"));
    EXPECT_EQ(lines[1], "pic,0,0,0,3.6e6,3.6e6,10,2");
    EXPECT_EQ(lines[6], "apic,0.2,1.5e6,1e4,1.9e6,3.41e6,10,2");
}

TEST(EnergyPlot, DrawsAPngAndKeepsItsScript)
{
    if (!canPlot()) GTEST_SKIP() << "no gnuplot here";
    TemporaryFolder folder;
    std::filesystem::create_directory(folder / "it's a");
    test::writeFile(folder.path() / "it's a" / "energy.csv", kEnergies);
    plotEnergies({{"a", "it's_PIC", folder.path() / "it's a" / "energy.csv"}}, "Dam break", folder.path());
    const std::string png = test::contentOf(folder / "energy.png");
    EXPECT_TRUE(png.starts_with("\x89PNG"));
    EXPECT_GT(png.size(), 5000u) << "curves and axes, not an empty page";
    EXPECT_NE(test::contentOf(folder / "energy.gp").find("10^{6} erg"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "energy.png.part"));
}

TEST(EnergyPlot, ReportsErrorsOfGnuplot)
{
    if (!canPlot()) GTEST_SKIP() << "no gnuplot here";
    TemporaryFolder folder;
    test::writeFile(folder / "a.csv", "time_s\n");
    try {
        plotEnergies({{"a", "A", folder / "a.csv"}}, "Empty", folder.path());
        FAIL() << "a plot of nothing";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("energy.png"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "energy.png"));
}

TEST(EnergyPlot, ParticlesAreTheirColumns)
{
    const std::string script = perParticleScript({{"apic", "APIC", "energy.csv", 7}}, "Splash", "p.png");
    const auto column = [](const std::string& name) {
        const std::vector<std::string> columns = csvCells(std::string(kEnergyHeader));
        return std::to_string(std::ranges::find(columns, name) - columns.begin() + 1);
    };
    EXPECT_NE(script.find("$" + column("total_erg") + "/($" + column("particles") + "+7)"), std::string::npos) << script;
    EXPECT_NE(script.find("$" + column("published_erg") + "/($" + column("particles") + "+7)"), std::string::npos) << script;
}

/// Methods differ by less than a line is wide: what one has more than the first of its scene has a panel of its own.
TEST(EnergyPlot, DifferencesToTheFirstMethodHaveAPanel)
{
    std::vector<EnergyCurve> curves = {{"apic", "APIC", "first.csv"}, {"polypic", "PolyPIC", "other.csv"}};
    EXPECT_NE(perParticleScript(curves, "Splash", "p.png").find("multiplot layout 1,2"), std::string::npos);
    curves[1].difference = {.times = {0.0, 0.05, 0.2}, .percent = {0.0, 0.25, -0.5}};
    const std::string script = perParticleScript(curves, "Splash", "p.png");
    EXPECT_NE(script.find("multiplot layout 1,3"), std::string::npos) << script;
    EXPECT_NE(script.find("$difference_1 << END\n0,0\n0.05,0.25\n0.2,-0.5\nEND\n"), std::string::npos) << script;
    EXPECT_EQ(script.find("$difference_0"), std::string::npos) << script;
}

}  // namespace
}  // namespace app
