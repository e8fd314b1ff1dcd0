#include "tests/app/import/imported.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>

namespace app {
namespace {

namespace fs = std::filesystem;
using test::countFabric;
using test::FabricCounts;
using test::Imported;

/// The scenes that libWetCloth and its PolyPIC fork publish, which are not ours to keep: DRENCH_LIBWETCLOTH_SCENES
/// names their folder.
fs::path publishedScenes()
{
    const char* named = std::getenv("DRENCH_LIBWETCLOTH_SCENES");
    return named ? fs::path(named) : fs::path(DRENCH_SOURCE_DIR).parent_path() / "shared" / "libwetcloth-scenes";
}

/// What is known to be in a file.
struct Published {
    const char* name;
    FabricCounts fabric;
    std::size_t sources = 0, obstacles = 0;
    bool domain = false;
    double particles = 0.0;  ///< of liquid at the start; 0: not known
    std::size_t orphans = 0;
    const char* words = "";  ///< that stand in the scene
};

void PrintTo(const Published& scene, std::ostream* out) { *out << scene.name; }

constexpr FabricCounts kNone{};
constexpr FabricCounts kStrips{.vertices = 52, .faces = 48, .held = 8, .pieces = 2};
constexpr FabricCounts kSheet{.vertices = 9801, .faces = 19208, .held = 8, .pieces = 1};
constexpr double kDamBreak = 313'501.0, kBall = 9876.0, kFineBall = 26'532.0;

const Published kAll[] = {
    {"dam_break_small_APIC", kNone, 1, 1, false, kDamBreak, 1611, "method: apic"},
    {"dam_break_small_PIC", kNone, 1, 1, false, kDamBreak, 1611, "method: pic"},
    {"dam_break_small_PolyPIC", kNone, 1, 1, false, kDamBreak, 1611, "method: polypic"},
    {"dam_mini_APIC", kNone, 1, 1, false, 0.0, 1611, "method: apic"},
    {"dam_mini_PolyPIC", kNone, 1, 1, false, 0.0, 1611, "method: polypic"},
    {"impermeable_small", {.vertices = 10000, .faces = 19602, .held = 64, .pieces = 1}, 1, 0, true, kBall, 0, "pin: {corners: all, patch: 4}"},
    {"simple_cloth", kStrips, 0, 0, false, 0.0, 0, "name: group3"},
    {"simple_fluid", kNone, 1, 1, false, 0.0, 0, "inside: true"},
    {"simple_plastic", kStrips, 0, 0, false, 0.0, 0, "cloth_grid:"},
    {"simple_surf_tension", kNone, 1, 0, false, 0.0, 0, "surface_tension_force: true"},
    {"simple_yarn", {.vertices = 28, .edges = 26, .held = 2, .pieces = 2}, 0, 0, false, 0.0, 0, "strand:"},
    {"simple_yarn_loop", {.vertices = 20, .edges = 19, .held = 4, .pieces = 1}, 0, 0, false, 0.0, 0, "twist: true"},
    {"splash_cloth_small_APIC", kSheet, 1, 1, true, kBall, 0, "nodes: [99, 99]"},
    {"splash_cloth_small_PolyPIC", kSheet, 1, 1, true, kBall, 0, "pin: {corners: [x- z-, x- z+], patch: 2}"},
    {"splash_cloth_small_near_APIC", kSheet, 1, 1, true, kBall, 0, "nodes: [99, 99]"},
    {"splash_yarn_small_APIC", {.vertices = 19604, .edges = 19800, .held = 12, .pieces = 1}, 1, 0, true, kFineBall, 0, "weave: herringbone"},
};

class PublishedScene : public testing::TestWithParam<Published> {
 protected:
    void SetUp() override
    {
        xml = publishedScenes() / (std::string(GetParam().name) + ".xml");
        if (!fs::exists(xml))
            GTEST_SKIP() << "no " << xml.filename() << ": DRENCH_LIBWETCLOTH_SCENES does not name a folder with the published scenes";
    }
    fs::path xml;
};

TEST_P(PublishedScene, HasTheCountsOfTheInventory)
{
    const Published& published = GetParam();
    const Imported imported(xml);
    const sim::Scene scene = imported.scene();
    EXPECT_EQ(countFabric(scene), published.fabric);
    EXPECT_EQ(scene.sources.size(), published.sources);
    EXPECT_EQ(scene.obstacles.size(), published.obstacles);
    EXPECT_EQ(scene.domain.has_value(), published.domain);
    EXPECT_THAT(imported.yaml(), testing::HasSubstr(published.words));
    const std::string dropped = fmt::format("{} particles belong to no cloth", published.orphans);
    EXPECT_EQ(imported.report.find(dropped) != std::string::npos, published.orphans > 0);
    const std::string yaml = imported.yaml();
    EXPECT_LE(std::ranges::count(yaml, '\n'), 90) << "generators, not lists";
    EXPECT_EQ(imported.yaml().find("nodes: [0,"), std::string::npos) << "pins have words";
}

TEST_P(PublishedScene, StartsWithThePublishedLiquid)
{
    if (GetParam().particles == 0.0) GTEST_SKIP() << "no published number of particles";
    const Imported imported(xml);
    const auto simulation = imported.start(imported.setup());
    EXPECT_NEAR(static_cast<double>(simulation->state().liquid.count) / GetParam().particles, 1.0, 0.02);
}

TEST_P(PublishedScene, RunsFor50Steps)
{
    const Imported imported(xml);
    const LoadedScene setup = imported.setup();
    const auto simulation = imported.start(setup);
    const double end = 50.0 * setup.scene.settings.time.dt;
    for (int i = 0; i < 50; ++i) simulation->step(end);
    EXPECT_NEAR(simulation->state().time, end, 1.0e-9) << "of the file's dt, in whole steps";
    EXPECT_EQ(simulation->state().liquid.count > 0, GetParam().sources > 0);
}

std::string nameOf(const testing::TestParamInfo<Published>& scene) { return scene.param.name; }

INSTANTIATE_TEST_SUITE_P(All, PublishedScene, testing::ValuesIn(kAll), nameOf);

TEST(PublishedImport, MeshThatIsMissingIsNamed)
{
    const fs::path xml = publishedScenes() / "simple_fluid_mesh.xml";
    if (!fs::exists(xml)) GTEST_SKIP() << "DRENCH_LIBWETCLOTH_SCENES does not name a folder with the published scenes";
    const Imported imported(xml);
    EXPECT_THAT(imported.yaml(), testing::HasSubstr("cylinder: {center: [0, 4, 0], axis: [0, 1, 0], radius: 1, half: 1.25, round: 0.25}"));
    try {
        imported.setup();
        FAIL() << "there is no mesh";
    } catch (const sim::InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("there is no file \"" + (imported.folder() / "assets/meshes/spot_triangulated.obj").string()));
    }
}

TEST(PublishedImport, EveryPublishedSceneIsInTheTable)
{
    if (!fs::is_directory(publishedScenes())) GTEST_SKIP() << "DRENCH_LIBWETCLOTH_SCENES does not name a folder with the published scenes";
    for (const auto& entry : fs::directory_iterator(publishedScenes())) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() != ".xml" || name == "simple_fluid_mesh") continue;
        if (std::ranges::find(kAll, name, [](const Published& p) { return std::string(p.name); }) == std::end(kAll)) {
            const Imported imported(entry.path());
            EXPECT_NO_THROW(imported.setup()) << name;
        }
    }
}

}  // namespace
}  // namespace app
