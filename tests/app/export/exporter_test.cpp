#include "app/export/exporter.h"

#include "app/export/geometry_files.h"
#include "app/system/thread_limit.h"
#include "sim/core/check.h"
#include "tests/app/export/geometry_in_test.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <locale>
#include <map>
#include <set>

namespace app {
namespace {

using nlohmann::json;
using test::contentOf;
using test::TemporaryFolder;
using test::WetScene;

constexpr GeometryFormats kAll = {.vtp = true, .ply = true, .obj = true, .usda = true};

std::set<std::string> namesIn(const std::filesystem::path& folder)
{
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

/// Every file of a folder by its name.
std::map<std::string, std::string> contentsIn(const std::filesystem::path& folder)
{
    std::map<std::string, std::string> contents;
    for (const std::string& name : namesIn(folder)) contents[name] = contentOf(folder / name);
    return contents;
}

TEST(Exporter, CollectionsAreWholeAfterEveryFrame)
{
    const TemporaryFolder folder;
    Exporter exporter(folder.path(), {}, 0.3);
    WetScene scene;
    json expected = json::array();
    for (int frame = 0; frame < 3; ++frame) {
        exporter.write(scene.frame(frame));
        expected.push_back({scene.state.time, "liquid_0000" + std::to_string(frame) + ".vtp"});
        EXPECT_EQ(test::readGeometry({folder / "liquid.pvd"})[0], expected);
        scene.move(0.3);
    }
    EXPECT_EQ(expected[2][0], 0.6);
    for (const json& entry : expected) {
        const json part = test::readGeometry({folder / entry[1].get<std::string>()})[0];
        EXPECT_EQ(part.at("time"), entry[0]);
    }
}

TEST(Exporter, ARunThatGoesOnKeepsItsEarlierFrames)
{
    const TemporaryFolder whole, inTwo;
    std::vector<FrameTime> written;
    WetScene scene;
    Exporter uninterrupted(whole.path(), kAll, 0.1);
    for (int frame = 0; frame < 4; ++frame) {
        uninterrupted.write(scene.frame(frame));
        Exporter(inTwo.path(), kAll, 0.1, written).write(scene.frame(frame));
        written.push_back({frame, scene.state.time});
        scene.move(0.1);
    }
    EXPECT_TRUE(contentsIn(whole.path()) == contentsIn(inTwo.path()));
}

TEST(Exporter, ParticlesMayComeAndGo)
{
    const TemporaryFolder folder;
    Exporter exporter(folder.path(), kAll, 0.01);
    std::vector<std::filesystem::path> files;
    for (int frame = 0; frame < 3; ++frame) {
        exporter.write(WetScene(std::array{5, 0, 9}[frame]).frame(frame));
        for (const char* extension : {"vtp", "ply"}) files.push_back(folder / geometryFileName("liquid", frame, extension));
    }
    const json read = test::readGeometry(files);
    for (std::size_t f = 0; f < files.size(); ++f) EXPECT_EQ(read[f].at("points").size(), (std::array{5u, 0u, 9u}[f / 2])) << files[f];
}

TEST(Exporter, OnlyTheWantedFormatsAreWritten)
{
    const TemporaryFolder folder;
    WetScene scene;
    Exporter(folder / "vtp", {.vtp = true}, 0.01).write(scene.frame());
    EXPECT_EQ(namesIn(folder / "vtp"),
              (std::set<std::string>{"cloth.pvd", "cloth_00000.vtp", "liquid.pvd", "liquid_00000.vtp", "obstacle_big_tank.pvd",
                                     "obstacle_big_tank_00000.vtp", "yarns.pvd", "yarns_00000.vtp"}));
    Exporter(folder / "ply", {.vtp = false, .ply = true}, 0.01).write(scene.frame(12));
    EXPECT_EQ(namesIn(folder / "ply"),
              (std::set<std::string>{"cloth_00012.ply", "liquid_00012.ply", "obstacle_big_tank_00012.ply", "yarns_00012.ply"}));
    Exporter(folder / "obj", {.vtp = false, .obj = true}, 0.01).write(scene.frame(123456));
    EXPECT_EQ(namesIn(folder / "obj"), std::set<std::string>{"frame_123456.obj"});
    Exporter(folder / "usda", {.vtp = false, .usda = true}, 0.01).write(scene.frame());
    EXPECT_EQ(namesIn(folder / "usda"), (std::set<std::string>{"animation.usda", "frame_00000.usda", "topology.usda"}));
}

TEST(Exporter, AFabricWithoutLiquidLeavesNoLiquid)
{
    WetScene scene(0);
    scene.state.emittedVolume.clear();
    scene.state.nextId = 0;
    std::ranges::fill(scene.state.fabric.absorbed, 0.0);
    ExportFrame frame = scene.frame();
    ASSERT_EQ(frame.parts.size(), 3u);
    EXPECT_EQ(frame.parts[0].name, "yarns");
    scene.state.fabric.absorbed[7] = 1e-3;  // which may drip
    frame = scene.frame();
    ASSERT_EQ(frame.parts.size(), 4u);
    EXPECT_EQ(frame.parts[0].name, "liquid");
}

TEST(Exporter, LiquidWithoutFabricLeavesNoFabric)
{
    WetScene scene;
    scene.fabric = {};
    scene.state.fabric = {};
    scene.obstacles.clear();
    const TemporaryFolder folder;
    Exporter(folder.path(), kAll, 0.01).write(scene.frame());
    EXPECT_EQ(namesIn(folder.path()), (std::set<std::string>{"animation.usda", "frame_00000.obj", "frame_00000.usda", "liquid.pvd",
                                                             "liquid_00000.ply", "liquid_00000.vtp", "topology.usda"}));
}

TEST(Exporter, ThreadsLeaveTheSameBits)
{
    const WetScene scene(30001);
    std::map<std::string, std::string> contents[2];
    for (const int threads : {1, 2}) {
        const TemporaryFolder folder;
        withThreads(threads, [&] { Exporter(folder.path(), kAll, 0.01).write(scene.frame()); });
        contents[threads - 1] = contentsIn(folder.path());
    }
    ASSERT_GT(contents[0].at("liquid_00000.vtp").size(), 1u << 19);
    for (const auto& [name, content] : contents[0]) EXPECT_TRUE(content == contents[1].at(name)) << name;
}

TEST(Exporter, DecimalPointsDoNotFollowTheLocale)
{
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    WetScene scene(2000);
    scene.move(0.5);
    const TemporaryFolder plain, foreign;
    Exporter(plain.path(), kAll, 0.004).write(scene.frame(1234));
    const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
    Exporter(foreign.path(), kAll, 0.004).write(scene.frame(1234));
    std::locale::global(before);
    EXPECT_TRUE(contentsIn(plain.path()) == contentsIn(foreign.path()));
}

TEST(Exporter, AFileThatCannotBeWrittenLeavesNothingBehind)
{
    const TemporaryFolder folder;
    Exporter exporter(folder.path(), {}, 0.01);
    std::filesystem::create_directories(folder / "liquid_00001.vtp" / "in the way");
    exporter.write(WetScene().frame(0));
    const auto before = contentsIn(folder.path());
    EXPECT_THROW(exporter.write(WetScene().frame(1)), std::runtime_error);
    EXPECT_TRUE(contentsIn(folder.path()) == before) << "no part of frame 1, and collections of frame 0 alone";
}

TEST(Exporter, AFolderThatIsAFileIsRefusedInOneLine)
{
    const TemporaryFolder folder;
    test::writeFile(folder / "geometry", "a file");
    try {
        Exporter(folder / "geometry", {}, 0.01);
        FAIL() << "not refused";
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("geometry: this is a file, not a folder"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace app
