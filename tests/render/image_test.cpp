#include "render/image.h"

#include "render/image_compare.h"

#include <gtest/gtest.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

namespace {

using namespace render;
namespace fs = std::filesystem;

/// Every colour channel varies; odd sizes catch wrong strides.
Image testCard(int width = 61, int height = 37)
{
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            fill(image, {x, y, 1, 1},
                 {static_cast<std::uint8_t>(x * 4), static_cast<std::uint8_t>(y * 6), static_cast<std::uint8_t>((x * 31 + y * 17) % 256)});
    return image;
}

/// A folder of its own, gone at the end.
struct Folder {
    explicit Folder(const char* name) : path(fs::path(testing::TempDir()) / name)
    {
        fs::remove_all(path);
        fs::create_directories(path);
    }
    ~Folder() { fs::remove_all(path); }
    std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(path), fs::directory_iterator()); }
    fs::path path;
};

std::string messageOf(const auto& action)
{
    try {
        action();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "no exception";
}

TEST(Png, RoundTripIsExact)
{
    const Folder folder("png_round_trip");
    const Image image = testCard();
    writePng(image, folder.path / "card.png");
    EXPECT_TRUE(readPng(folder.path / "card.png") == image);
    EXPECT_EQ(folder.files(), 1) << "nothing is left beside it";
}

TEST(Png, MissingFolderIsNamed)
{
    const std::string message = messageOf([] { writePng(testCard(), "no/such/folder/card.png"); });
    EXPECT_NE(message.find("no/such/folder/card.png"), std::string::npos) << message;
    EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

TEST(Png, FullDiskIsAnErrorThatLeavesTheOldPicture)
{
    const Folder folder("png_full_disk");
    const Image old = testCard(8, 8);
    writePng(old, folder.path / "card.png");
    // A limit on file sizes stands for the full disk: writes fail half way.
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit tiny = {2000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &tiny);
    const std::string message = messageOf([&] { writePng(testCard(300, 300), folder.path / "card.png"); });
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(message.find("card.png: File too large"), std::string::npos) << message;
    EXPECT_EQ(folder.files(), 1);
    EXPECT_TRUE(readPng(folder.path / "card.png") == old);
}

TEST(Png, BrokenFileIsNamed)
{
    const Folder folder("png_broken");
    std::ofstream(folder.path / "text.png") << "this is no picture";
    const std::string message = messageOf([&] { readPng(folder.path / "text.png"); });
    EXPECT_NE(message.find("text.png"), std::string::npos) << message;
}

TEST(Image, PasteAndFillStayInside)
{
    Image image(10, 10);
    paste(testCard(6, 6), 7, -3, image);
    EXPECT_EQ(image.color(7, 0), testCard(6, 6).color(0, 3));
    EXPECT_EQ(image.color(6, 0), (Rgb{255, 255, 255}));
    EXPECT_EQ(image.color(7, 3), (Rgb{255, 255, 255}));
    fill(image, {-5, -5, 100, 100}, {1, 2, 3});
    EXPECT_EQ(image.color(9, 9), (Rgb{1, 2, 3}));
    EXPECT_THROW(Image(0, 5), std::invalid_argument);
}

TEST(Similarity, SamePictureIsOneAndOthersAreLess)
{
    const Image image = testCard();
    EXPECT_NEAR(structuralSimilarity(image, image).mean, 1.0, 1e-12);
    EXPECT_NEAR(structuralSimilarity(image, image).lowest, 1.0, 1e-9);

    Image spotted = image;
    fill(spotted, {20, 20, 3, 3}, {255, 255, 255});
    const Similarity spot = structuralSimilarity(spotted, image);
    EXPECT_LT(spot.mean, 0.999);
    EXPECT_LT(spot.lowest, 0.7) << "the worst window sees a small thing";
    EXPECT_NEAR(spot.x, 21, 5) << "and tells where";
    EXPECT_NEAR(spot.y, 21, 5);

    Image shifted(image.width, image.height);
    paste(image, 2, 0, shifted);
    EXPECT_LT(structuralSimilarity(shifted, image).mean, 0.9);
    EXPECT_THROW(structuralSimilarity(image, Image(3, 3)), std::invalid_argument);
}

TEST(Similarity, ConstantPicturesFollowTheClosedForm)
{
    // Without structure only the term of the means is left: (2ab + c1) / (a² + b² + c1).
    const Image a(20, 20, {100, 100, 100}), b(20, 20, {150, 150, 150});
    const double c1 = 2.55 * 2.55;
    const double expected = (2.0 * 100 * 150 + c1) / (100.0 * 100 + 150.0 * 150 + c1);
    EXPECT_NEAR(structuralSimilarity(a, b).mean, expected, 1e-9);
}

TEST(Similarity, ColorsAreCountedWhereTheyCanBeSeen)
{
    const Image image(10, 10, {100, 100, 100});
    Image changed = image;
    fill(changed, {2, 3, 4, 1}, {100, 100, 104});
    EXPECT_EQ(colorDifference(image, changed).share, 0.0);
    EXPECT_EQ(colorDifference(image, changed).largest, 4);
    fill(changed, {7, 5, 2, 1}, {100, 91, 100});
    const ColorDifference difference = colorDifference(image, changed);
    EXPECT_DOUBLE_EQ(difference.share, 0.02);
    EXPECT_EQ(difference.largest, 9);
    EXPECT_EQ(difference.x, 7);
    EXPECT_EQ(difference.y, 5);
    EXPECT_THROW(colorDifference(image, Image(3, 3)), std::invalid_argument);
}

TEST(Similarity, DifferenceImageIsRedWhereAndOnlyWhereTheyDiffer)
{
    const Image image = testCard();
    Image changed = image;
    changed.at(5, 7)[1] ^= 1;
    const Image difference = differenceImage(changed, image);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Rgb c = difference.color(x, y);
            EXPECT_EQ(c.r != c.g, x == 5 && y == 7);
        }
}

}  // namespace
