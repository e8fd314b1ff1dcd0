#include "sim/scene/load_scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

const char* const kScene = "grid: {cell: 0.1}\nliquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n";

/// A folder of scene files, gone after the test.
class SceneFiles : public testing::Test {
 protected:
    void SetUp() override
    {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / (std::string("drench_scene_files_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "inner");
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }

    /// The message of loading it, with file names relative to the folder; "" if it loads.
    std::string messageOf(const std::string& name) const
    {
        try {
            sim::loadScene(folder_ / name);
        } catch (const sim::InputError& e) {
            std::string message = e.what();
            const std::string prefix = folder_.string() + "/";
            for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
            return message;
        }
        return "";
    }

    fs::path folder_;
};

TEST_F(SceneFiles, OfTheFixtureLoad)
{
    write("good.yaml", kScene);
    EXPECT_EQ("", messageOf("good.yaml"));
}

TEST_F(SceneFiles, ThatAreMissingAreNamed) { EXPECT_EQ("nowhere.yaml: there is no file \"nowhere.yaml\"", messageOf("nowhere.yaml")); }

TEST_F(SceneFiles, ThatAreFoldersAreRefused) { EXPECT_EQ("inner: \"inner\" is no file", messageOf("inner")); }

TEST_F(SceneFiles, OfBinaryGarbageAreRefused)
{
    std::string bytes;
    for (int i = 0; i < 4096; ++i) bytes += static_cast<char>((i * 197 + 13) % 256);
    write("garbage.yaml", bytes);
    EXPECT_EQ("garbage.yaml:1: a byte that is no text (not UTF-8); a scene is a YAML text file", messageOf("garbage.yaml"));
}

TEST_F(SceneFiles, ThatAreHugeAreRefused)
{
    write("huge.yaml", kScene);
    fs::resize_file(folder_ / "huge.yaml", (16u << 20) + 1);
    EXPECT_EQ("huge.yaml: \"huge.yaml\" is larger than 16 MB; meshes go to files of their own", messageOf("huge.yaml"));
}

TEST_F(SceneFiles, MayStartWithAByteOrderMark)
{
    write("mark.yaml", std::string("\xEF\xBB\xBF") + kScene);
    EXPECT_EQ("", messageOf("mark.yaml"));
}

TEST_F(SceneFiles, IncludedInACircleAreRefused)
{
    write("a.yaml", "include: [inner/b.yaml]\n");
    write("inner/b.yaml", "drench: 1\ninclude: [../a.yaml]\n");
    EXPECT_EQ("inner/b.yaml:2: include goes round in a circle: \"a.yaml\" is being read already", messageOf("a.yaml"));
}

TEST_F(SceneFiles, IncludedByThemselvesAreRefused)
{
    write("a.yaml", "include: a.yaml\n");
    EXPECT_EQ("a.yaml:1: include goes round in a circle: \"a.yaml\" is being read already", messageOf("a.yaml"));
}

TEST_F(SceneFiles, IncludedButMissingNameTheIncludingLine)
{
    write("a.yaml", "drench: 1\ninclude:\n  - nowhere.yaml\n");
    EXPECT_EQ("a.yaml:3: there is no file \"nowhere.yaml\"", messageOf("a.yaml"));
}

TEST_F(SceneFiles, IncludedTooOftenAreRefused)
{
    write("leaf.yaml", "drench: 1\n");
    std::string previous = "leaf.yaml";
    for (int i = 0; i < 10; ++i) {
        const std::string name = "level" + std::to_string(i) + ".yaml";
        write(name, "include: [" + previous + ", " + previous + "]\n");
        previous = name;
    }
    EXPECT_NE(std::string::npos, messageOf(previous).find("more than 100 included files")) << messageOf(previous);
}

TEST_F(SceneFiles, MistakesInIncludedFilesNameThatFile)
{
    write("a.yaml", std::string("include: [inner/b.yaml]\n") + kScene);
    write("inner/b.yaml", "time:\n  dt: soon\n");
    EXPECT_EQ("inner/b.yaml:2: time.dt: \"soon\" is no number; needs a time like 0.5 or \"0.5 s\"", messageOf("a.yaml"));
}

TEST_F(SceneFiles, MistakesInMeshesNameSceneAndMesh)
{
    write("inner/broken.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    write("inner/a.yaml", "grid: {cell: 0.1}\nliquid:\n  sources:\n    - shape: {mesh: {file: broken.obj}}\n");
    const std::string message = messageOf("inner/a.yaml");
    EXPECT_EQ(0u, message.find("inner/a.yaml:4: liquid.sources.0.shape.mesh: inner/broken.obj:3: ")) << message;
}

TEST_F(SceneFiles, OpenMeshesAreRefusedAtTheirLine)
{
    write("plate.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n");
    write("open.yaml", std::string(kScene) + "obstacles:\n  - shape: {mesh: {file: plate.obj}}\n");
    const std::string message = messageOf("open.yaml");
    EXPECT_EQ(0u, message.find("open.yaml:")) << message;
    EXPECT_NE(std::string::npos, message.find("not closed")) << message;
    EXPECT_NE(std::string::npos, message.find("from vertex 1 (0, 0, 0) to vertex 2 (1, 0, 0) cm")) << message;
}

TEST_F(SceneFiles, MeshesHaveTheUnitOfTheirScene)
{
    write("cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const auto sizeOf = [&](const std::string& units, const std::string& scale) {
        write("a.yaml", units + "grid: {cell: 1 cm}\nliquid:\n  sources:\n    - shape: {mesh: {file: cube.obj, cell: 1 cm" + scale + "}}\n");
        EXPECT_EQ("", messageOf("a.yaml"));
        return sim::loadScene(folder_ / "a.yaml").sources[0].shape.bounds().sizes()[0];
    };
    EXPECT_DOUBLE_EQ(100.0, sizeOf("units: si\n", ""));
    EXPECT_DOUBLE_EQ(2.0, sizeOf("units: si\n", ", scale: 0.02"));
    EXPECT_DOUBLE_EQ(2.0, sizeOf("units: si\n", ", scale: 2 cm"));
    EXPECT_DOUBLE_EQ(1.0, sizeOf("", ""));
    EXPECT_DOUBLE_EQ(2.0, sizeOf("", ", scale: 2"));
}

TEST_F(SceneFiles, MeshesAreFoundBesideTheIncludedFile)
{
    write("inner/tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write("inner/mesh.yaml", "liquid:\n  sources:\n    - shape: {mesh: {file: tetrahedron.obj, cell: 0.1}}\n");
    write("a.yaml", "include: [inner/mesh.yaml]\ngrid: {cell: 0.1}\n");
    ASSERT_EQ("", messageOf("a.yaml"));
    EXPECT_LT(sim::loadScene(folder_ / "a.yaml").sources[0].shape.distance(sim::Vec3(0.2, 0.2, 0.2)), 0.0);
}

}  // namespace
