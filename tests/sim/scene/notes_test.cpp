// What a scene that can be run tells its user nevertheless.
#include "sim/scene/load_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

constexpr const char* kPool = "liquid: {sources: [{name: pool, shape: {box: {min: [-1, 3, -1], max: [1, 4, 1]}}}]}\n";
constexpr const char* kYarn =
    "materials: {thread: {young: 1.0e+6}}\n"
    "fabrics: [{name: yarn, strand: {material: thread, from: [-1, 5, 0], to: [1, 5, 0], segments: 4, radius: 0.05}}]\n";

/// What a scene says of walls: a plate or a mesh of this thickness [cm], with or without liquid, in cells of 0.25 cm.
std::vector<std::string> notesOf(const std::string& obstacles, bool hasLiquid = true)
{
    return sim::readScene(
               sim::sceneFileFromText("grid: {cell: 0.25}\n" + std::string(hasLiquid ? kPool : kYarn) + "obstacles:\n" + obstacles, "thin.yaml"))
        .notes;
}

std::string plate(const std::string& name, double thickness, const std::string& more = "")
{
    return fmt::format("  - {{name: {}, shape: {{box: {{min: [-2, 0, -2], max: [2, {}, 2]}}}}{}}}\n", name, thickness, more);
}

TEST(Notes, NameThinWallsOnceAndHowThickTheyAre)
{
    const std::vector<std::string> notes = notesOf(plate("lid", 0.1) + plate("floor", 1.0) + plate("table", 0.45));
    ASSERT_EQ(2u, notes.size());
    EXPECT_NE(std::string::npos, notes[0].find("thin.yaml:4: obstacle lid is 0.1 cm thick, 0.4 cells")) << notes[0];
    EXPECT_NE(std::string::npos, notes[0].find("a grid.cell of 0.05 cm would resolve it")) << notes[0];
    EXPECT_NE(std::string::npos, notes[1].find("obstacle table is 0.45 cm thick, 1.8 cells")) << notes[1];
}

TEST(Notes, NameThinWallsHoweverTheyAreTurnedOrMove)
{
    for (const char* more : {", motion: [{t: [0, 1], translate: [0, 1, 0]}]", ", friction_angle: 30", ", collide: false"})
        EXPECT_EQ(1u, notesOf(plate("lid", 0.1, more)).size()) << more;
    const auto turned = notesOf("  - {name: lid, shape: {box: {min: [-2, 0, -2], max: [2, 0.1, 2]}, rotate: {axis: [1, 2, 3], angle: 40}}}\n");
    ASSERT_EQ(1u, turned.size());
    EXPECT_NE(std::string::npos, turned[0].find("obstacle lid is 0.")) << turned[0];
}

TEST(Notes, SayNothingOfThickWallsVesselsAndScenesWithoutLiquid)
{
    EXPECT_TRUE(notesOf(plate("floor", 0.55)).empty());
    EXPECT_TRUE(notesOf(plate("tank", 4.0, ", inside: true")).empty());
    EXPECT_TRUE(notesOf("  - {name: post, shape: {ball: {center: [0, 5, 0], radius: 0.5}}}\n").empty());
    EXPECT_TRUE(notesOf(plate("lid", 0.1), false).empty());
}

TEST(Notes, NameClothWhoseVerticesAreFartherApartThanCellsOfSolverGrid)
{
    const auto notes = [](const std::string& solver, double spacing, double cell) {
        const std::string grid = fmt::format("grid: {{cell: {}}}\nfabric: {{solver: {}}}\n", cell, solver);
        const std::string cloth =
            fmt::format("fabrics: [{{name: sheet, cloth_grid: {{material: thread, nodes: [9, 9], spacing: {}, radius: 0.02}}}}]\n", spacing);
        return sim::readScene(sim::sceneFileFromText(grid + kPool + "materials: {thread: {young: 1.0e+6}}\n" + cloth, "wide.yaml")).notes;
    };
    const std::vector<std::string> wide = notes("grid", 0.25, 0.125);
    ASSERT_EQ(1u, wide.size());
    EXPECT_NE(std::string::npos, wide[0].find("vertices of fabric sheet are 0.25 cm apart, 2 cells")) << wide[0];
    EXPECT_TRUE(notes("grid", 0.25, 0.25).empty());
    EXPECT_TRUE(notes("vertex", 0.25, 0.125).empty());
}

TEST(Notes, ASourceThatIsAskedForNothingSaysSo)
{
    const auto notes = [](const std::string& source) {
        return sim::readScene(sim::sceneFileFromText("grid: {cell: 0.25}\ntime: {duration: 2}\nliquid:\n  sources:\n    - {name: jet, "
                                                     "shape: {ball: {center: [0, 5, 0], radius: 1}}, " +
                                                         source + "}\n",
                                                     "good.yaml"))
            .notes;
    };
    EXPECT_TRUE(notes("velocity: [0, 1, 0], emit: [{from: 0, to: 1}]").empty());
    EXPECT_TRUE(notes("velocity: [0, 0, 0]").empty());
    ASSERT_EQ(1u, notes("emit: [{from: 0, to: 1}]").size());
    EXPECT_NE(std::string::npos, notes("emit: [{from: 0, to: 1}]")[0].find("liquid.sources.jet.emit: without a velocity"));
    ASSERT_EQ(1u, notes("velocity: [0, 1, 0], emit: [{from: 3, to: 4}, {from: 0, to: 1}]").size());
    EXPECT_NE(std::string::npos, notes("velocity: [0, 1, 0], emit: [{from: 3, to: 4}]")[0].find("nothing comes from 3 to 4 s"));
}

std::vector<std::string> notesOnSettings(const std::string& text, const std::vector<std::string>& set = {})
{
    return sim::readScene(sim::sceneFileFromText(text, "unread.yaml", {"", set})).notes;
}

TEST(Notes, NameSettingsThatNothingReadsAndWhatWould)
{
    const std::string pool = "grid: {cell: 0.25}\n" + std::string(kPool);
    const auto expectOne = [&](const std::string& text, const std::string& note) {
        const std::vector<std::string> notes = notesOnSettings(pool + text);
        ASSERT_EQ(1u, notes.size()) << text;
        EXPECT_EQ(note, notes[0]);
    };
    expectOne("transfer: {flip_ratio: 0.5}\n", "unread.yaml:3: transfer.flip_ratio: has no effect here; it goes with transfer.method flip");
    expectOne("transfer: {method: apic, modes: 6}\n",
              "unread.yaml:3: transfer.modes.liquid: has no effect here; it goes with transfer.method polypic");
    expectOne("solver: {viscosity_tolerance: 1.0e-3}\n",
              "unread.yaml:3: solver.viscosity_tolerance: has no effect here; it goes with liquid.solve_viscosity true");
    expectOne("coupling: {drag: linear}\n", "unread.yaml:3: coupling.drag: has no effect here; it goes with fabrics");
    expectOne("transfer: {modes: {fabric: 4}}\n", "unread.yaml:3: transfer.modes.fabric: has no effect here; it goes with fabric.solver grid");
}

TEST(Notes, NameWhatBodiesAreGivenInVain)
{
    const std::string yarn = "grid: {cell: 0.25}\n" + std::string(kYarn);
    EXPECT_EQ((std::vector<std::string>{"unread.yaml:3: fabrics.yarn.wetness: has no effect here; it goes with pores, a volume_fraction of its "
                                        "material or of porous below 1"}),
              notesOnSettings(yarn, {"fabrics.0.wetness=0.5"}));
    EXPECT_TRUE(notesOnSettings(yarn, {"fabrics.0.wetness=0.5", "materials.thread.volume_fraction=0.4"}).empty());
    const std::string pool = "grid: {cell: 0.25}\n" + std::string(kPool),
                      post = "obstacles: [{name: post, shape: {ball: {center: [0, 9, 0], radius: 1}}}]\n";
    EXPECT_EQ(1u, notesOnSettings(pool, {"liquid.sources.0.fill.seed=7"}).size());
    EXPECT_TRUE(notesOnSettings(pool, {"liquid.sources.0.fill.seed=7", "liquid.sources.0.fill.pattern=jittered"}).empty());
    EXPECT_EQ(1u, notesOnSettings(yarn + post, {"obstacles.0.cohesive=false"}).size());
    EXPECT_EQ(1u, notesOnSettings(yarn + post, {"obstacles.0.friction_angle=3", "obstacles.0.collide=false"}).size());
    EXPECT_TRUE(notesOnSettings(yarn + post, {"obstacles.0.friction_angle=3"}).empty());
    EXPECT_TRUE(notesOnSettings(yarn + post, {"obstacles.0.cohesive=false", "coupling.cohesion.strength=1"}).empty());
}

TEST(Notes, LeaveToEachVariantWhatItReads)
{
    const std::string text =
        "grid: {cell: 0.25}\n" + std::string(kPool) + "transfer: {flip_ratio: 0.5}\ncompare: {variants: [{name: flip, transfer.method: flip}]}\n";
    EXPECT_TRUE(notesOnSettings(text).empty());
    EXPECT_EQ(1u, notesOnSettings(text, {"transfer.flip_ratio=0.4"}).size()) << "but it was asked for now";
}

TEST(Notes, SayNothingOfSettingsThatAreReadOrAreTheirDefaults)
{
    const std::string pool = "grid: {cell: 0.25}\n" + std::string(kPool);
    EXPECT_TRUE(notesOnSettings(pool + "transfer: {method: flip, flip_ratio: 0.5}\n").empty());
    EXPECT_TRUE(notesOnSettings(pool + "transfer: {flip_ratio: 0.99}\nfabric: {newton: 2}\n").empty());
    EXPECT_TRUE(notesOnSettings(pool + "transfer: {method: apic}\n").empty()) << "the fabric's part is not given";
    const std::string yarn = "grid: {cell: 0.25}\n" + std::string(kYarn) + "fabric: {newton: 3}\n";
    EXPECT_TRUE(notesOnSettings(yarn).empty());
    EXPECT_EQ(1u, notesOnSettings(yarn, {"fabric.solver=grid"}).size());
    EXPECT_EQ(1u, notesOnSettings(yarn, {"materials.thread.pin_stiffness=1"}).size());
    const sim::Scene printed = sim::readScene(sim::sceneFileFromText(yarn, "yarn.yaml"));
    EXPECT_TRUE(notesOnSettings(sim::printScene(printed)).empty()) << "all settings written out";
}

}  // namespace
