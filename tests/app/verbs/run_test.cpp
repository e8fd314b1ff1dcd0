#include "app/frames/frame_pipeline.h"
#include "app/pictures/video.h"
#include "tests/app/program.h"

namespace app {
namespace {

using nlohmann::json;
using test::Program;

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

}  // namespace
}  // namespace app
