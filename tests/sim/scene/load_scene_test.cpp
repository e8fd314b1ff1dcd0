#include "sim/scene/load_scene.h"
#include "tests/sim/scene/liquid_scene.h"

#include "sim/core/units.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace {

using sim::Scene;
using sim::Vec3;

using sim::test::kGrid, sim::test::kSmallest, sim::test::load;

TEST(LoadScene, LeavesDefaultsWhereTheSceneSaysNothing)
{
    const Scene scene = load(kSmallest);
    const sim::Settings defaults;
    const sim::Settings& s = scene.settings;
    EXPECT_EQ(defaults.time.dt, s.time.dt);
    EXPECT_EQ(defaults.time.duration, s.time.duration);
    EXPECT_EQ(defaults.time.start, s.time.start);
    EXPECT_EQ(defaults.time.mode, s.time.mode);
    EXPECT_EQ(defaults.time.maxCflFabric, s.time.maxCflFabric);
    EXPECT_EQ(defaults.gravity, s.gravity);
    EXPECT_EQ(defaults.transfer.method, s.transfer.method);
    EXPECT_EQ(defaults.transfer.modes, s.transfer.modes);
    EXPECT_EQ(defaults.transfer.dampingDt, s.transfer.dampingDt);
    EXPECT_EQ(defaults.fabricTransfer.method, s.fabricTransfer.method);
    EXPECT_EQ(defaults.liquid.density, s.liquid.density);
    EXPECT_EQ(defaults.liquid.contactAngle, s.liquid.contactAngle);
    EXPECT_EQ(defaults.liquid.wallFriction, s.liquid.wallFriction);
    EXPECT_EQ(defaults.liquid.relax.rate, s.liquid.relax.rate);
    EXPECT_EQ(defaults.solver.maxIterations, s.solver.maxIterations);
    EXPECT_EQ(0.1, s.cell);
    EXPECT_EQ("good", scene.name);
    EXPECT_EQ("good.yaml", scene.file);
    EXPECT_TRUE(scene.obstacles.empty());
    EXPECT_FALSE(scene.domain.has_value());
}

TEST(LoadScene, EverySettingOfAFileArrives)
{
    const Scene scene = load(R"(
drench: 1
scene: {name: all, title: All of it, description: Every key, tags: [a, b]}
time: {dt: 1.0e-2, duration: 2, start: 1, mode: cfl, cfl: 0.5, max_cfl: {liquid: 2, fabric: 0.25}, dt_min: 1.0e-9, integrator: reflected}
grid: {cell: 0.2}
gravity: [1, 2, 3]
transfer:
  method: {liquid: flip, fabric: apic}
  modes: {liquid: 11, fabric: 4}
  xi: affine
  flip_ratio: 0.9
  damping: {liquid_affine: 0.8, fabric_stretch: 0.7, fabric_rotation: 0.6, fabric_velocity: 0.5}
  damping_dt: 1.0e-3
  damp_modes: false
solver: {pressure_tolerance: 1.0e-4, max_iterations: 50, viscosity_tolerance: 1.0e-3}
liquid:
  density: 2
  viscosity: 3
  surface_tension: 4
  contact_angle: 90
  particle_spacing: 0.5
  full: true
  wall_friction: 0.25
  relax: {rate: 10, range: 1.5}
  solve_viscosity: true
  surface_tension_force: true
  curvature_smoothing: 5
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      velocity: [1, 0, 0]
      fill: {pattern: jittered, seed: 18446744073709551615}
      emit: [{from: 1, to: 1}, {from: 2, to: 3, max_volume: 5, velocity: [0, 1, 0]}]
domain: {box: {min: [-9, -9, -9], max: [9, 9, 9]}}
)");
    const sim::Settings& s = scene.settings;
    EXPECT_EQ("all", scene.name);
    EXPECT_EQ("All of it", scene.title);
    EXPECT_EQ((std::vector<std::string>{"a", "b"}), scene.tags);
    EXPECT_EQ(1.0e-2, s.time.dt);
    EXPECT_EQ(2.0, s.time.duration);
    EXPECT_EQ(sim::TimeMode::Cfl, s.time.mode);
    EXPECT_EQ(0.5, s.time.cfl);
    EXPECT_EQ(2.0, s.time.maxCflLiquid);
    EXPECT_TRUE(s.time.reflects());
    EXPECT_EQ(0.25, s.time.maxCflFabric);
    EXPECT_EQ(1.0e-9, s.time.dtMin);
    EXPECT_EQ(Vec3(1, 2, 3), s.gravity);
    EXPECT_EQ(sim::TransferMethod::Flip, s.transfer.method);
    EXPECT_EQ(sim::TransferMethod::Apic, s.fabricTransfer.method);
    EXPECT_EQ(11, s.transfer.modes);
    EXPECT_EQ(4, s.fabricTransfer.modes);
    EXPECT_EQ(sim::XiMap::Affine, s.fabricTransfer.xi);
    EXPECT_EQ(0.9, s.transfer.flipRatio);
    EXPECT_EQ(0.8, s.transfer.affineDamping);
    EXPECT_EQ(0.6, s.fabricTransfer.rotationDamping);
    EXPECT_EQ(1.0e-3, s.transfer.dampingDt);
    EXPECT_FALSE(s.transfer.dampModes);
    EXPECT_EQ(1.0e-4, s.solver.pressureTolerance);
    EXPECT_EQ(50, s.solver.maxIterations);
    EXPECT_EQ(1.0e-3, s.solver.viscosityTolerance);
    EXPECT_TRUE(s.liquid.solveViscosity);
    EXPECT_EQ(2.0, s.liquid.density);
    EXPECT_EQ(4.0, s.liquid.surfaceTension);
    EXPECT_EQ(0.5 * sim::kPi, s.liquid.contactAngle);
    EXPECT_TRUE(s.liquid.full);
    EXPECT_EQ(1.5, s.liquid.relax.range);
    EXPECT_TRUE(s.liquid.surfaceTensionForce);
    EXPECT_EQ(5, s.liquid.curvatureSmoothing);
    const sim::SourceSettings& source = scene.sources.at(0);
    EXPECT_EQ("0", source.name);
    EXPECT_EQ("good.yaml:29", source.where);
    EXPECT_EQ(sim::FillSettings::Pattern::Jittered, source.fill.pattern);
    EXPECT_EQ(18446744073709551615u, source.fill.seed);
    EXPECT_EQ(0.5, source.fill.spacing);
    ASSERT_EQ(2u, source.emissions.size());
    EXPECT_EQ(Vec3(1, 0, 0), source.emissions[0].velocity);
    EXPECT_EQ(5.0, source.emissions[1].maxVolume);
    EXPECT_EQ(Vec3(0, 1, 0), source.emissions[1].velocity);
    EXPECT_TRUE(scene.domain.has_value());
}

TEST(LoadScene, SiFileIsTheSameAsCgsFile)
{
    const Scene cgs = load(R"(
time: {dt: 1.0e-3}
grid: {cell: 0.288}
gravity: [0, -981, 0]
liquid:
  density: 1.2
  viscosity: 8.9e-3
  surface_tension: 72
  contact_angle: 30
  relax: {rate: 100}
  sources: [{shape: {ball: {center: [0, 2, 0], radius: 1.5}}, velocity: [0, -10, 0]}]
)");
    const Scene si = load(R"(
units: si
time: {dt: 1.0e-3}
grid: {cell: 0.00288}
gravity: [0, -9.81, 0]
liquid:
  density: 1200
  viscosity: 8.9e-4
  surface_tension: 0.072
  contact_angle: 30
  relax: {rate: 100}
  sources: [{shape: {ball: {center: [0, 0.02, 0], radius: 0.015}}, velocity: [0, -0.1, 0]}]
)");
    EXPECT_EQ(cgs.settings.time.dt, si.settings.time.dt);
    EXPECT_DOUBLE_EQ(cgs.settings.cell, si.settings.cell);
    EXPECT_DOUBLE_EQ(cgs.settings.gravity[1], si.settings.gravity[1]);
    EXPECT_DOUBLE_EQ(cgs.settings.liquid.density, si.settings.liquid.density);
    EXPECT_DOUBLE_EQ(cgs.settings.liquid.viscosity, si.settings.liquid.viscosity);
    EXPECT_DOUBLE_EQ(cgs.settings.liquid.surfaceTension, si.settings.liquid.surfaceTension);
    EXPECT_EQ(cgs.settings.liquid.contactAngle, si.settings.liquid.contactAngle);
    EXPECT_EQ(cgs.settings.liquid.relax.rate, si.settings.liquid.relax.rate);
    EXPECT_DOUBLE_EQ(cgs.sources[0].emissions[0].velocity[1], si.sources[0].emissions[0].velocity[1]);
    EXPECT_NEAR(cgs.sources[0].shape.distance(Vec3(5, 0, 0)), si.sources[0].shape.distance(Vec3(5, 0, 0)), 1.0e-12);
}

TEST(LoadScene, PresetsSetConstantsAndKeysOverrideThem)
{
    const auto liquid = [](const std::string& keys) {
        return load(kGrid + "liquid: {" + keys + ", sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n").settings.liquid;
    };
    EXPECT_EQ(80.0, liquid("preset: honey").viscosity);
    EXPECT_EQ(1.45, liquid("preset: honey").density);
    EXPECT_EQ(32.0, liquid("preset: oil").surfaceTension);
    EXPECT_EQ(0.7802, liquid("preset: acetal").density);
    EXPECT_EQ(8.9e-3, liquid("preset: water").viscosity);
    EXPECT_EQ(50.0, liquid("viscosity: 50, preset: honey").viscosity);
    EXPECT_EQ(sim::LiquidSettings().density, liquid("preset: none").density);
}

TEST(LoadScene, TransferHasShortForms)
{
    EXPECT_EQ(sim::TransferMethod::Pic, load(kSmallest + "transfer: pic\n").settings.transfer.method);
    const sim::Settings s = load(kSmallest + "transfer: {liquid: flip, fabric: pic}\n").settings;
    EXPECT_EQ(sim::TransferMethod::Flip, s.transfer.method);
    EXPECT_EQ(sim::TransferMethod::Pic, s.fabricTransfer.method);
    EXPECT_EQ(sim::TransferMethod::Apic, load(kSmallest + "transfer: flip\n").settings.fabricTransfer.method) << "fabric never runs flip";
    EXPECT_TRUE(load(kSmallest + "transfer: {damping_dt: step}\n").settings.transfer.dampingPerStep);
}

TEST(LoadScene, AnchorsAreCopiedOut)
{
    const Scene scene = load(kGrid + R"(
liquid: {sources: [{shape: &ball {ball: {center: [0, 0, 0], radius: 1}}}]}
obstacles: [{shape: *ball, inside: true}]
)");
    EXPECT_DOUBLE_EQ(1.0, scene.obstacles[0].shape.distance(Vec3::Zero()));
    EXPECT_TRUE(scene.obstacles[0].inside);
}

TEST(LoadScene, ShippedScenesLoadInAllVariants)
{
    int scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(SCENES_DIR)) {
        if (entry.path().extension() != ".yaml") continue;
        ++scenes;
        EXPECT_NO_THROW(sim::loadScene(entry.path())) << entry.path();
        for (const std::string& variant : sim::variantNames(entry.path())) EXPECT_NO_THROW(sim::loadScene(entry.path(), {variant, {}})) << variant;
    }
    EXPECT_GE(scenes, 3);
}

TEST(LoadScene, DamBreakIsTheOneOfThePaper)
{
    const std::filesystem::path file = std::filesystem::path(SCENES_DIR) / "dam_break_small.yaml";
    EXPECT_EQ((std::vector<std::string>{"pic", "flip", "apic", "polypic", "paper_apic", "paper_polypic", "best"}), sim::variantNames(file));
    const Scene scene = sim::loadScene(file);
    EXPECT_EQ(0.288, scene.settings.cell);
    EXPECT_EQ(1.0, scene.settings.liquid.wallFriction);
    EXPECT_EQ(sim::FillSettings::Pattern::Reference, scene.sources[0].fill.pattern);
    const Eigen::AlignedBox3d column = scene.sources[0].shape.bounds();
    EXPECT_TRUE(column.min().isApprox(Vec3(-1.92, -0.72, -0.72), 1e-12));
    EXPECT_TRUE(column.max().isApprox(Vec3(7.92, 15.84, 2.16), 1e-12));
    EXPECT_GT(0.0, -scene.obstacles[0].shape.distance(Vec3(-7.2, 14.4, 0.72)) + 0.0);
    const Scene best = sim::loadScene(file, {"best", {}});
    EXPECT_EQ(sim::FillSettings::Pattern::Lattice, best.sources[0].fill.pattern);
    EXPECT_EQ(sim::TimeMode::Adaptive, best.settings.time.mode);
}

TEST(LoadScene, IncludedFilesLieUnderTheFileInOrder)
{
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "drench_include_order";
    std::filesystem::create_directories(folder / "inner");
    const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
    write("first.yaml", kSmallest + "time: {dt: 1, duration: 1, start: 1}\n");
    write("inner/second.yaml", "units: si\ninclude: third.yaml\ntime: {dt: 2, duration: 2}\ngrid: {cell: 0.01}\n");
    write("inner/third.yaml", "solver: {max_iterations: 3}\ntime: {dt: 9}\n");
    write("top.yaml", "include: [first.yaml, inner/second.yaml]\ntime: {dt: 3}\n");
    const sim::Settings s = sim::loadScene(folder / "top.yaml").settings;
    std::filesystem::remove_all(folder);
    EXPECT_EQ(3.0, s.time.dt) << "the file itself is on top";
    EXPECT_EQ(2.0, s.time.duration) << "later includes win";
    EXPECT_EQ(1.0, s.time.start);
    EXPECT_EQ(3, s.solver.maxIterations);
    EXPECT_DOUBLE_EQ(1.0, s.cell) << "numbers keep the units of the file they stand in";
    EXPECT_EQ(-sim::kEarthGravity, s.gravity[1]);
}

}  // namespace
