#include "app/pictures/video.h"
#include "app/pictures/side_by_side.h"
#include "tests/app/fake_backends.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using test::EnvironmentVariable;
using test::TemporaryFolder;

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
    const auto backends = test::toyBackends({});
    const auto setup = test::toySetup({});
    const auto draw = backends.startRenderer(setup, true);
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
    const auto made = composeSideBySide(sequences, 0.01, setup.pictures, backends, folder.path(), [] { return false; });
    EXPECT_EQ(made, folder / "side_by_side");
    EXPECT_TRUE(std::filesystem::exists(made / frameFileName(2)));
    EXPECT_FALSE(std::filesystem::exists(made / frameFileName(3)));
}

}  // namespace
}  // namespace app
