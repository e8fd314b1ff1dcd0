// drench diff on pictures, as a process.

#include "app/pictures/video.h"
#include "app/system/child_process.h"
#include "render/image.h"
#include "tests/app/temporary_folder.h"

#include <fmt/format.h>

#include <sys/wait.h>
#include <algorithm>
#include <cstdio>

namespace app::test {
namespace {

using render::Image;

/// Stripes, so that there is structure everywhere.
Image stripes()
{
    Image image(80, 60, {200, 210, 220});
    for (int x = 0; x < 80; x += 8) render::fill(image, {x, 0, 4, 60}, {30, 60, static_cast<std::uint8_t>(2 * x)});
    return image;
}

/// The same with a square in it that is not expected.
Image spoiled()
{
    Image image = stripes();
    render::fill(image, {40, 20, 6, 6}, {255, 0, 0});
    return image;
}

/// What a program wrote to its standard output, and its exit code.
struct Told {
    int code = -1;
    std::string text;
};

Told tell(const std::string& command)
{
    Told told;
    std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) told.text += static_cast<char>(c);
    told.code = WEXITSTATUS(pclose(pipe));
    return told;
}

class DiffPictures : public testing::Test {
 protected:
    Told diff(const std::string& arguments) const { return tell(fmt::format("cd {} && {} diff {}", folder.path().string(), TOY_PROGRAM, arguments)); }
    void expect(int code, const std::string& mentions, const Told& told) const
    {
        EXPECT_EQ(told.code, code) << told.text;
        EXPECT_NE(told.text.find(mentions), std::string::npos) << told.text;
        EXPECT_EQ(std::ranges::count(told.text, '\n'), 1) << told.text;
    }
    void put(const std::string& name, const Image& image) const
    {
        std::filesystem::create_directories((folder / name).parent_path());
        render::writePng(image, folder / name);
    }
    TemporaryFolder folder;
};

TEST_F(DiffPictures, TellHowMuchDiffersAndWhere)
{
    put("a.png", stripes());
    put("b.png", spoiled());
    expect(0, "same: ", diff("a.png a.png"));
    const Told told = diff("a.png b.png");
    expect(1, "different: a.png: mean SSIM", told);
    EXPECT_NE(told.text.find("0.75 % of pixels over 4/255, largest difference 225 at (40, 20)"), std::string::npos) << "36 of 4800: " << told.text;
    EXPECT_NE(told.text.find("(at least 0.9)"), std::string::npos) << told.text;
}

TEST_F(DiffPictures, ThatCannotBeComparedExitWithTwo)
{
    put("a.png", stripes());
    writeFile(folder / "broken.png", contentOf(folder / "a.png").substr(0, 90));
    std::filesystem::create_directories(folder / "empty");
    put("some/a.png", stripes());
    expect(2, "there is no such file", diff("a.png none.png"));
    expect(2, "broken.png", diff("a.png broken.png"));
    expect(2, "there are no pictures", diff("some empty"));
    expect(2, "is a folder of pictures", diff("a.png some"));
    expect(2, "--out some", diff("some some --out some"));
    expect(2, "--subset", diff("a.png a.png --subset"));
    expect(2, "drench", diff("a.png"));
}

TEST_F(DiffPictures, OfAnotherSizeDiffer)
{
    put("a.png", stripes());
    put("b.png", Image(80, 61));
    expect(1, "80 x 60 pixels against 80 x 61", diff("a.png b.png"));
}

TEST_F(DiffPictures, InFoldersGoByNameAndNoneMayBeMissing)
{
    for (const char* name : {"frame_0.png", "frame_1.png", "frame_2.png"}) put(std::string("a/") + name, stripes());
    put("b/frame_0.png", stripes());
    put("b/frame_1.png", spoiled());
    put("b/frame_2.png", stripes());
    expect(1, "different: frame_1.png", diff("a b"));
    put("b/frame_1.png", stripes());
    expect(0, "0 of 3 pictures", diff("a b"));
    std::filesystem::remove(folder / "a" / "frame_1.png");
    expect(1, "frame_1.png: only B has it", diff("a b"));
    expect(0, "0 of 2 pictures", diff("a b --subset"));
    expect(1, "frame_1.png: only A has it", diff("b a --subset"));
}

TEST_F(DiffPictures, TolerancesComeFromAFileBesideThemOrFromTheCommandLine)
{
    put("a/x.png", stripes());
    put("b/x.png", spoiled());
    expect(1, "different", diff("a b"));
    writeFile(folder / "loose.yaml", "mean_ssim: 0.5\nlowest_ssim: -1\n");
    expect(0, "same", diff("a b --tolerances loose.yaml"));
    expect(1, "largest difference 225 (at most 200)", diff("a b --tolerances loose.yaml --set largest=200"));
    writeFile(folder / "scene.yaml", "drench: 1\ncompare: {tolerance: {mean_ssim: 0.5, lowest_ssim: -1}}\n");
    expect(0, "same", diff("a b --tolerances scene.yaml"));
    std::filesystem::rename(folder / "loose.yaml", folder / "a" / "tolerance.yaml");
    expect(0, "same", diff("a b"));
    expect(1, "different", diff("b a"));
    writeFile(folder / "a" / "tolerance.yaml", "mean_ssim: 0.5\nlowst_ssim: -1\n");
    expect(2, "a/tolerance.yaml:2: unknown key \"lowst_ssim\" in tolerance (did you mean \"lowest_ssim\"?)", diff("a b"));
    expect(2, "none.yaml", diff("a b --tolerances none.yaml"));
}

TEST_F(DiffPictures, StandOnAPageTheWorstFirst)
{
    put("a/one.png", stripes());
    put("a/two.png", stripes());
    put("a/three & four.png", stripes());
    put("b/one.png", spoiled());
    put("b/two.png", Image(80, 60));
    put("b/three & four.png", stripes());
    std::filesystem::create_directories(folder / "page");
    writeFile(folder / "page" / "diff_old.png", "of an earlier comparison");
    expect(1, "2 of 3 pictures differ", diff("a b --out page"));
    const std::string html = contentOf(folder / "page" / "diff.html");
    const auto two = html.find("<figcaption class=\"differs\">two.png"), one = html.find("<figcaption class=\"differs\">one.png");
    ASSERT_NE(one, std::string::npos);
    EXPECT_LT(two, one) << "a white picture is worse than one with a square";
    EXPECT_EQ(html.find("three & four"), std::string::npos);
    EXPECT_NE(html.find("three &amp; four"), std::string::npos);
    EXPECT_EQ(html.find("src=\"diff_"), std::string::npos) << "it needs no other file";
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder / "page" / "diff_old.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "page" / "diff_three & four.png"));
    const Image panels = render::readPng(folder / "page" / "diff_one.png");
    EXPECT_GE(panels.width, 3 * 80);
    EXPECT_GE(panels.height, 60);
}

TEST_F(DiffPictures, InVideosAreTheirFrames)
{
    if (!canMakeVideos()) GTEST_SKIP() << "there is no ffmpeg";
    for (int n = 0; n < 5; ++n) {
        put(fmt::format("a/frame_{:05d}.png", n), stripes());
        put(fmt::format("b/frame_{:05d}.png", n), n == 3 ? Image(80, 60) : stripes());
    }
    for (const char* name : {"a", "b"}) videoOfFrames(folder / name, folder / (std::string(name) + ".mp4"), 25.0, "libx264");
    expect(0, "0 of 5 pictures", diff("a.mp4 a.mp4"));
    expect(1, "frame_00003.png", diff("a.mp4 b.mp4"));
    writeFile(folder / "c.mp4", "no video");
    expect(2, "c.mp4", diff("a.mp4 c.mp4"));
}

/// idiff of OpenImageIO as a second opinion.
TEST_F(DiffPictures, AreAsFarApartAsAnotherProgramFindsThem)
{
    if (!findProgram("idiff")) GTEST_SKIP() << "there is no idiff: openimageio-tools has it";
    put("a.png", stripes());
    put("b.png", spoiled());
    const Told other = tell(fmt::format("idiff -fail 0.017 -hardfail 1 {0}/a.png {0}/b.png", folder.path().string()));
    EXPECT_NE(other.code, 0);
    EXPECT_NE(other.text.find("36 pixels (0.75%) over 0.017"), std::string::npos) << other.text;
    EXPECT_NE(other.text.find("@ (40, 20, R)"), std::string::npos) << other.text;
    const Told same = tell(fmt::format("idiff {0}/a.png {0}/a.png", folder.path().string()));
    EXPECT_EQ(same.code, 0) << same.text;
}

}  // namespace
}  // namespace app::test
