#include "sim/core/check.h"
#include "sim/scene/load_scene.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace {

using app::test::TemporaryFolder;
using app::test::writeFile;

const std::string kScene = "grid: {cell: 0.2}\nliquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n";

/// What reading the text as folder/a/scene.yaml complains about; empty if it does not.
std::string complaint(const TemporaryFolder& folder, const std::string& text, const sim::ReadingBounds& bounds)
{
    try {
        sim::readScene(sim::sceneFileFromText(text, folder / "a" / "scene.yaml", {.bounds = bounds}));
        return "";
    } catch (const sim::InputError& error) {
        return error.what();
    }
}

TEST(ReadingBounds, FilesMustLieBelowTheFolder)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a");
    std::filesystem::create_directory(folder / "ab");
    writeFile(folder / "a" / "part.yaml", kScene);
    writeFile(folder / "ab" / "part.yaml", kScene);
    std::filesystem::create_symlink(folder / "ab" / "part.yaml", folder / "a" / "link.yaml");
    const sim::ReadingBounds bounds{.folder = folder / "a"};
    EXPECT_EQ(complaint(folder, "include: part.yaml\n", bounds), "");
    EXPECT_EQ(complaint(folder, "include: ../ab/part.yaml\n", {}), "");
    for (const char* outside : {"../ab/part.yaml", "/etc/passwd", "link.yaml"}) {
        EXPECT_NE(complaint(folder, "include: " + std::string(outside) + "\n", bounds).find("does not lie below"), std::string::npos) << outside;
        const std::string mesh = kScene + "obstacles: [{shape: {mesh: {file: " + outside + "}}}]\n";
        EXPECT_NE(complaint(folder, mesh, bounds).find("does not lie below"), std::string::npos) << outside;
    }
}

TEST(ReadingBounds, TextsAskForNoMoreThanTheyMay)
{
    const TemporaryFolder folder;
    const sim::ReadingBounds bounds{.values = 60, .vertices = 20};
    const std::string cloth =
        kScene + "materials: {m: {young: 1e7}}\nfabrics: [{cloth_grid: {material: m, nodes: [5, 4], spacing: 1, radius: 0.1}}]\n";
    EXPECT_EQ(complaint(folder, cloth, bounds), "");
    EXPECT_NE(complaint(folder, cloth, {.vertices = 19}).find("at most"), std::string::npos);
    EXPECT_NE(complaint(folder,
                        kScene + "scene: {tags: &a [x, x, x, x, x, x, x, x, x, x, x, x], title: *a}\n" +
                            "x: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15]\n",
                        bounds)
                  .find("more than 60 values"),
              std::string::npos);
}

}  // namespace
