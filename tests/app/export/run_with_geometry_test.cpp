// Runs that leave geometry.

#include "app/runs/run_offline.h"
#include "tests/app/export/geometry_in_test.h"
#include "tests/app/fake_backends.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using nlohmann::json;
using test::TemporaryFolder;

void runToy(const test::ToySettings& toy, const std::filesystem::path& out, bool geometry)
{
    LoadedScene setup = test::toySetup(toy);
    setup.scene.settings.liquid.density = 4.0;
    setup.pictures.output.geometry = geometry;
    runOffline(setup, test::toyBackends(toy), {.out = out, .contentHash = "0123", .frames = false});
}

TEST(RunWithGeometry, EveryFrameIsThereAtItsTime)
{
    const TemporaryFolder folder;
    runToy({}, folder.path(), true);
    const json frames = test::readGeometry({folder.path() / "geometry/liquid.pvd"})[0];
    ASSERT_EQ(frames.size(), 6u);
    for (int frame = 0; frame < 6; ++frame) {
        EXPECT_NEAR(frames[frame][0].get<double>(), 0.01 * frame, 1e-15);
        const json part = test::readGeometry({folder.path() / "geometry" / frames[frame][1].get<std::string>()})[0];
        EXPECT_NEAR(part.at("points")[0][0].get<double>(), 0.01 * frame, 1e-8) << "the toy goes at 1 cm/s";
        EXPECT_EQ(part.at("arrays").at("volume").at("values"), json::parse("[[0.5]]")) << "2 g of liquid";
    }
}

TEST(RunWithGeometry, ThereIsNoneUnlessTheSceneWantsIt)
{
    const TemporaryFolder folder;
    runToy({}, folder.path(), false);
    EXPECT_TRUE(std::filesystem::exists(folder / "report.json"));
    EXPECT_FALSE(std::filesystem::exists(folder / "geometry"));
}

TEST(RunWithGeometry, AnotherRunTakesAwayWhatTheLastHasLeft)
{
    const TemporaryFolder folder;
    runToy({}, folder.path(), true);
    const auto geometry = folder / "geometry";
    for (const char* own : {"obstacle_tank_00003.ply.part", "frame_00007.obj", "animation.usda"}) test::writeFile(geometry / own, "old");
    for (const char* others : {"notes.txt", "liquid_surface.vtp", "frame_7.obj"}) test::writeFile(geometry / others, "mine");
    test::ToySettings shorter;
    shorter.duration = 0.02;
    runToy(shorter, folder.path(), true);
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(geometry)) names.insert(entry.path().filename().string());
    EXPECT_EQ(names, (std::set<std::string>{"frame_7.obj", "liquid.pvd", "liquid_00000.vtp", "liquid_00001.vtp", "liquid_00002.vtp",
                                            "liquid_surface.vtp", "notes.txt", "provenance.json"}));
    for (const char* others : {"notes.txt", "liquid_surface.vtp", "frame_7.obj"}) std::filesystem::remove(geometry / others);
    runToy(shorter, folder.path(), false);
    EXPECT_FALSE(std::filesystem::exists(geometry));
}

}  // namespace
}  // namespace app
