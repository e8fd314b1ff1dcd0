// Pictures of real scenes, drawn without a window.
#include "app/backends.h"
#include "app/frames/snapshot_from_state.h"
#include "render/image.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace app::test {
namespace {

LoadedScene load(const std::string& name, std::vector<std::string> sets)
{
    return drenchBackends().loadScene({.file = DRENCH_SOURCE_DIR "/scenes/" + name + ".yaml", .variant = "", .sets = std::move(sets)});
}

/// A run as far as `time` [s].
std::unique_ptr<SimulationHandle> runTo(double time, const LoadedScene& setup)
{
    auto simulation = drenchBackends().startSimulation(setup);
    while (simulation->state().time < time) simulation->step(time);
    return simulation;
}

FrameSnapshot shotOf(const SimulationHandle& simulation, const LoadedScene& setup, const SnapshotExtras& extras)
{
    FrameSnapshot snapshot;
    fillSnapshot(simulation.state(), simulation.fabric(), simulation.contacts(), setup.scene.settings.liquid.density, extras, snapshot);
    drenchBackends().meshObstacles(setup)(simulation.state().time, snapshot.obstacles);
    return snapshot;
}

/// Drawn as the scene's file says. Kept to be looked at if DRENCH_KEEP_PICTURES names a folder.
render::Image pictureOf(FrameSnapshot& snapshot, const LoadedScene& setup, const std::string& name)
{
    const TemporaryFolder folder;
    const char* const keep = std::getenv("DRENCH_KEEP_PICTURES");
    const std::filesystem::path file = (keep != nullptr ? std::filesystem::path(keep) : folder / "") / (name + ".png");
    drenchBackends().startRenderer(setup, false)(snapshot)(file);
    return render::readPng(file);
}

/// Water at rest, 10 cm of it: what colours a particle is the weight of the water above, but for half a cell at the
/// bottom and at the surface, where the pressure of the last cells goes on.
TEST(Pictures, PressureAtRestIsTheWeightAbove)
{
    const LoadedScene setup = load("validation/hydrostatics", {"time.duration=0.05", "render.liquid.color_by=pressure"});
    const auto simulation = runTo(0.05, setup);
    FrameSnapshot snapshot = shotOf(*simulation, setup, extrasOf(setup.pictures.render));
    ASSERT_GT(snapshot.positions.size(), 1000u);
    constexpr double kHeight = 10.0, kWeight = 981.0, kHalfCell = 0.25;
    std::size_t between = 0;
    for (std::size_t p = 0; p < snapshot.positions.size(); ++p) {
        const double depth = kHeight - snapshot.positions[p].y(), expected = kWeight * depth;
        ASSERT_NEAR(snapshot.values[p], expected, 1.1 * kHalfCell * kWeight) << "depth " << depth;
        if (depth < 2.0 * kHalfCell || depth > kHeight - kHalfCell) continue;
        ASSERT_NEAR(snapshot.values[p], expected, 0.02 * expected + 20.0) << "depth " << depth;
        ++between;
    }
    EXPECT_GT(between, snapshot.positions.size() / 2);
    const render::Image image = pictureOf(snapshot, setup, "pressure");
    // Jet: red is high, blue is low.
    const render::Rgb bottom = image.color(image.width / 2, image.height * 3 / 4), top = image.color(image.width / 2, image.height * 2 / 5);
    EXPECT_GT(bottom.r, bottom.b + 60) << +bottom.r << ' ' << +bottom.g << ' ' << +bottom.b;
    EXPECT_GT(top.b, top.r + 60) << +top.r << ' ' << +top.g << ' ' << +top.b;
}

/// A drop over a pool, as spheres and by its surface: the same outline, seen whole against the background.
TEST(Pictures, SurfaceCoversWhatItsParticlesDo)
{
    const std::vector<std::string> common = {"render.hud=false", "render.colorbar=false", "render.obstacles.style=hidden"};
    std::vector<render::Image> images;
    for (const std::string style : {"spheres", "surface"}) {
        std::vector<std::string> sets = common;
        sets.push_back("render.liquid.style=" + style);
        const LoadedScene setup = load("drop", sets);
        const auto simulation = runTo(0.05, setup);
        FrameSnapshot snapshot = shotOf(*simulation, setup, extrasOf(setup.pictures.render));
        EXPECT_EQ(style == "surface", !snapshot.surface.triangles.empty());
        images.push_back(pictureOf(snapshot, setup, "drop_" + style));
    }
    const auto isLiquid = [](const render::Rgb& color) { return color.r < 250 || color.g < 250 || color.b < 250; };
    int both = 0, either = 0;
    for (int y = 0; y < images[0].height; ++y)
        for (int x = 0; x < images[0].width; ++x) {
            const bool a = isLiquid(images[0].color(x, y)), b = isLiquid(images[1].color(x, y));
            both += a && b, either += a || b;
        }
    EXPECT_GT(either, 5000);
    EXPECT_GT(both, 0.95 * either) << "of the pixels that one has";
}

/// A small sheet of yarns under a ball that comes down on it: what pushes is nearer than it reaches, 2 r + r / 4, but
/// for the last move of the step.
TEST(Pictures, ContactsAreWhereYarnsTouch)
{
    const LoadedScene setup =
        load("yarn_sheet", {"fabrics.sheet.woven_yarns.yarns=[20, 20]", "obstacles.ball.shape={ball: {center: [1.4, 1.05, 1.4], radius: 0.8}}",
                            "render.camera={look_at: [1.4, 0, 1.4], eye: [1.4, 3.0, 6.0], fov: 40}"});
    const auto simulation = runTo(0.01, setup);
    FrameSnapshot snapshot = shotOf(*simulation, setup, {.contacts = true});
    ASSERT_EQ(snapshot.lines.size(), 1u);
    const auto& points = snapshot.lines[0].points;
    ASSERT_EQ(points.size(), 2 * simulation->contacts()->size());
    EXPECT_GT(points.size(), 20u);
    constexpr float kRadius = 0.048f;
    for (std::size_t i = 0; i < points.size(); i += 2) {
        EXPECT_LT((points[i + 1] - points[i]).norm(), 2.5f * kRadius);
        EXPECT_GT((points[i + 1] - points[i]).norm(), 0.5f * kRadius);
    }
    const render::Image with = pictureOf(snapshot, setup, "contacts");
    snapshot.lines.clear();
    EXPECT_FALSE(with == pictureOf(snapshot, setup, "no_contacts"));
}

/// Where the grid is and where the liquid goes, over the same picture.
TEST(Pictures, BlocksAndArrowsAreOverTheScene)
{
    const LoadedScene setup = load("drop", {"render.size=[960, 720]"});
    const auto simulation = runTo(0.06, setup);
    FrameSnapshot snapshot = shotOf(*simulation, setup, {.blocks = true, .arrows = true});
    EXPECT_EQ(snapshot.lines.size(), 3u);
    const render::Image with = pictureOf(snapshot, setup, "blocks_and_arrows");
    FrameSnapshot plain = shotOf(*simulation, setup, {});
    EXPECT_TRUE(plain.lines.empty());
    const render::Image without = pictureOf(plain, setup, "no_lines");
    int changed = 0;
    for (int y = 0; y < with.height; ++y)
        for (int x = 0; x < with.width; ++x) changed += with.color(x, y) != without.color(x, y);
    EXPECT_GT(changed, with.width * with.height / 100);
    EXPECT_LT(changed, with.width * with.height / 2);
}

}  // namespace
}  // namespace app::test
