#include "app/pictures/side_by_side.h"
#include "app/pictures/video.h"
#include "app/reports/compare_table.h"
#include "app/reports/energy_plot.h"
#include "app/system/gnuplot.h"
#include "app/system/progress.h"
#include "app/system/statistics.h"
#include "tests/app/fake_parts.h"
#include "tests/app/temporary_folder.h"

#include <cmath>

namespace app {
namespace {

using test::EnvironmentVariable;
using test::TemporaryFolder;

TEST(Progress, LineHasFrameTimeStepAndEta)
{
    const ProgressState state = {.frame = 37, .frames = 240, .time = 0.62, .dt = 1.9e-4, .secondsPerStep = 0.031, .secondsLeft = 372.0};
    EXPECT_EQ(progressLine(state), "frame 37/240 · t 0.62 s · dt 1.9e-4 · 0.031 s/step · ETA 6 m 12 s");
}

TEST(Progress, EtaIsTheRestAtThePaceSoFar)
{
    EXPECT_DOUBLE_EQ(secondsLeft(0.0, 0.25, 1.0, 60.0), 180.0);
    EXPECT_DOUBLE_EQ(secondsLeft(2.0, 2.5, 3.0, 10.0), 10.0);
    EXPECT_DOUBLE_EQ(secondsLeft(0.0, 1.0, 1.0, 60.0), 0.0);
    EXPECT_LT(secondsLeft(0.0, 0.0, 1.0, 5.0), 0.0) << "unknown before the first step";
}

TEST(Progress, DurationsReadLikeDurations)
{
    EXPECT_EQ(formatDuration(0.4), "0 s");
    EXPECT_EQ(formatDuration(59.6), "1 m 00 s");
    EXPECT_EQ(formatDuration(372.0), "6 m 12 s");
    EXPECT_EQ(formatDuration(3780.0), "1 h 03 m");
}

TEST(Progress, ElsewhereThanOnATerminalLinesEnd)
{
    TemporaryFolder folder;
    std::FILE* out = std::fopen((folder / "log").c_str(), "w");
    {
        Progress progress(out, "APIC", 0.0, 1.0, 10);
        progress.stepDone(0.5, 0.01, 0.2);
        progress.frameDone();
        progress.show();
    }
    std::fclose(out);
    const auto lines = test::linesOf(folder / "log");
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].starts_with("APIC  frame 1/10 · t 0.5 s · dt 1.0e-2 · 0.200 s/step · ETA ")) << lines[0];
}

TEST(Statistics, MedianIsTheMiddle)
{
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({3.0}), 3.0);
    EXPECT_EQ(median({9.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 9.0}), 3.0);
}

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
    EXPECT_NE(table.find("| relax | - | - |\n"), std::string::npos) << "a stage that never ran";
}

TEST(CompareTable, WithoutReferenceThereIsNoRatio)
{
    EXPECT_EQ(compareTable("T", {resultOf("APIC", 0.02)}, "").find("×"), std::string::npos);
}

const std::string kEnergies = "time_s,kinetic_erg,modal_erg,potential_erg,total_erg,particles,liquid_mass_g\n"
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

TEST(EnergyPlot, TellsWhatGnuplotDislikes)
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

TEST(Video, IsMissedWhereThereIsNoFfmpeg)
{
    const EnvironmentVariable path("PATH", "");
    EXPECT_FALSE(canMakeVideos());
    EXPECT_THROW(videoOfFrames(".", "video.mp4", 50.0, "libx264"), std::runtime_error);
}

TEST(Video, IsAnMp4OfAllPictures)
{
    if (!canMakeVideos()) GTEST_SKIP() << "no ffmpeg here";
    TemporaryFolder folder;
    const VideoFormat format = {.width = 33, .height = 17, .fps = 50.0};
    VideoWriter video(folder / "video.mp4", format);
    for (int n = 0; n < 5; ++n) video.add(std::vector<std::uint8_t>(3 * 33 * 17, static_cast<std::uint8_t>(50 * n)));
    EXPECT_FALSE(std::filesystem::exists(folder / "video.mp4")) << "not before it is whole";
    video.finish();
    EXPECT_EQ(test::contentOf(folder / "video.mp4").substr(4, 4), "ftyp");
    EXPECT_FALSE(std::filesystem::exists(folder / "video.mp4.part"));
}

TEST(Video, PicturesTooWideForPlayersAreScaledDown)
{
    const auto probe = findProgram("ffprobe");
    if (!canMakeVideos() || !probe) GTEST_SKIP() << "no ffmpeg here";
    TemporaryFolder folder;
    VideoWriter video(folder / "video.mp4", {.width = 2 * kMaxVideoWidth, .height = 64, .fps = 50.0});
    video.add(std::vector<std::uint8_t>(std::size_t{3} * 2 * kMaxVideoWidth * 64));
    video.finish();
    const ChildExit end = runChild(*findProgram("sh"), {"-c", "ffprobe -v error -show_entries stream=width,height -of csv=p=0 video.mp4 >&2"},
                                   {.folder = folder.path()});
    EXPECT_EQ(end.errorText, "4096,32\n");
}

TEST(Video, TellsWhyFfmpegFailed)
{
    if (!canMakeVideos()) GTEST_SKIP() << "no ffmpeg here";
    TemporaryFolder folder;
    try {
        VideoWriter video(folder / "video.mp4", {.width = 32, .height = 16, .fps = 50.0, .codec = "no_such_codec"});
        for (int n = 0; n < 1000; ++n) video.add(std::vector<std::uint8_t>(3 * 32 * 16));
        video.finish();
        FAIL() << "a video without a codec";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("no_such_codec"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ChildProcess, ArgumentsAreNotReadByAShell)
{
    const auto echo = findProgram("sh");
    ASSERT_TRUE(echo);
    const ChildExit end = runChild(*echo, {"-c", "printf '%s' \"$0\" >&2; exit 3", "a b; $(touch nothing) *"});
    EXPECT_EQ(end.code, 3);
    EXPECT_EQ(end.errorText, "a b; $(touch nothing) *");
}

TEST(ChildProcess, LastWordsAreTheLastLineThatSaysSomething)
{
    EXPECT_EQ((ChildExit{1, "first\nsecond \n\n"}).lastWords(), "second");
    EXPECT_EQ((ChildExit{1, "alone"}).lastWords(), "alone");
    EXPECT_EQ((ChildExit{7, " \n"}).lastWords(), "exit code 7, no message");
}

TEST(SideBySide, FramesAreMatchedByTimeNotByNumber)
{
    const FrameSequence dense = {.folder = "d", .label = "", .start = 0.0, .every = 0.001, .last = 100};
    const FrameSequence sparse = {.folder = "s", .label = "", .start = 0.0, .every = 0.004, .last = 25};
    EXPECT_EQ(dense.frameAt(0.08), 80);
    EXPECT_EQ(sparse.frameAt(0.08), 20);
    EXPECT_EQ(sparse.frameAt(0.0815), 20);
    EXPECT_EQ(sparse.frameAt(0.2), 25) << "a variant that is over stays as it ended";
}

TEST(SideBySide, WithoutFfmpegThereArePictures)
{
    TemporaryFolder folder;
    const auto parts = test::toyParts({});
    const auto setup = test::toySetup({});
    const auto draw = parts.startRenderer(setup, true);
    std::vector<FrameSequence> sequences;
    for (const char* name : {"a", "b"}) {
        std::filesystem::create_directory(folder / name);
        for (int n = 0; n < 3; ++n) {
            FrameSnapshot snapshot;
            snapshot.number = n;
            draw(snapshot)(folder.path() / name / frameFileName(n));
        }
        sequences.push_back({.folder = folder / name, .label = name, .start = 0.0, .every = 0.01, .last = 2});
    }
    const EnvironmentVariable path("PATH", "");
    const auto made = composeSideBySide(sequences, 0.01, setup.pictures, parts, folder.path(), [] { return false; });
    EXPECT_EQ(made, folder / "side_by_side");
    EXPECT_TRUE(std::filesystem::exists(made / frameFileName(2)));
    EXPECT_FALSE(std::filesystem::exists(made / frameFileName(3)));
}

}  // namespace
}  // namespace app
