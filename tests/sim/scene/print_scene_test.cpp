#include "app/scene/read_picture_settings.h"
#include "sim/scene/load_scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

std::string printed(const sim::SceneFile& file)
{
    return sim::printScene(sim::readScene(file)) + app::printPictureSettings(app::readPictureSettings(file));
}

/// What is printed loads to a scene that prints the same: no value is lost or changed.
void expectRoundTrip(const sim::SceneFile& file)
{
    const std::string once = printed(file);
    std::string twice;
    ASSERT_NO_THROW(twice = printed(sim::sceneFileFromText(once, "printed.yaml"))) << once;
    EXPECT_EQ(once, twice);
}

const char* const kEverything = R"(
units: si
scene: {name: everything, title: 'A "quoted": title, # with signs', tags: [a b, "c"]}
time: {dt: 1.23456789e-4, duration: 0.3, start: 0.1, mode: adaptive}
grid: {cell: 1.7 mm}
transfer: {method: {liquid: flip, fabric: pic}, modes: {liquid: 3, fabric: 5}, damping_dt: step, damping: {liquid_affine: 0.123}}
liquid:
  preset: acetal
  contact_angle: 0.7 rad
  particle_spacing: 0.31
  sources:
    - name: "null"
      shape: {subtract: [{ball: {center: [0, 0.1, 0], radius: 1/3 m}}, {box: {min: [0, 0, 0], max: [1, 1, 1]}}], rotate: {axis: [1, 1, 0], angle: 33}, translate: [0.01, 0, 0]}
      fill: {pattern: poisson, seed: 99, spacing: 0.7}
      emit: [{to: 0.2}, {from: 0.3, to: 0.4, max_volume: 3 ml, velocity: [1, 2, 3]}]
    - shape: {union: [{cylinder: {center: [0, 0.5, 0], radius: 0.1, half: 0.01, round: 1 mm}}, {capsule: {a: [0, 0, 0], b: [0, 0.1, 0], radius: 0.05}}]}
obstacles:
  - shape: {rounded_box: {min: [-9, -9, -9], max: [9, 9, 9], round: 0.1}}
    inside: true
  - name: paddle
    shape: {intersect: [{invert: {ball: {center: [5, 0, 0], radius: 0.1}}}, {ball: {center: [5, 0, 0], radius: 0.3}}]}
    motion:
      - {t: [0, 0.2], translate: [0, 0.1, 0], ease: [0.07, 0.05]}
      - {t: [0.2, 0.5], rotate: {axis: [0, 0, 1], angle: 77, origin: [0, 0.1, 0], frame: local}}
      - {t: [0.5, 1], oscillate: {direction: [1, 0, 0], amplitude: 0.1, frequency: 3}}
      - {t: [0.5, 1], oscillate: {axis: [1, 0, 0], amplitude: 11, frequency: 3}}
      - {keys: [[1, 0, 0, 0], [2, 0, 0.1, 0], [3, 0.1, 0.1, 0.1]], interp: linear}
domain: {box: {center: [0, 0, 0], half: [8, 8, 8]}}
render:
  background: [0.1, 0.2, 0.3]
  camera: {orbit: {target: [0, 0.1, 0], distance: 0.7, azimuth: 12.3, turn_per_s: 4}, fov: 33}
  liquid: {style: points, color_by: flat, colormap: viridis, range: [0.1, 2 m/s]}
output: {dir: some where, every: 1/3 s, frames: none, data: [stats], video: {fps: 24}}
compare: {variants: {transfer.method: [pic, apic], gravity: [[0, -9.81, 0], [0, 0, 0]]}, layout: grid, products: [sheet], reference: "apic, [0, 0, 0]"}
)";

const char* const kAllFabric = R"(
units: si
grid: {cell: 2 mm}
porous: {fibre_diameter: 0.1 mm, pore_radius: 0.07 mm}
coupling: {cohesion: {strength: 0.3, obstacle: false}}
fabric: {solver: "off", bending: hinge, hinge: {constant: 3, measure: sin}, tolerance: 1.0e-3}
materials:
  wool: {young: 1.0e+6, friction_angle: 0.31 rad, section_rotation: 11.1}
  "12": {young: 2.34 MPa, volume_fraction: 0.77, damp_bending: false}
fabrics:
  - cloth_grid: {material: wool, nodes: [5, 4], size: [0.1, 0.07], center: [0, 0.1, 0], u: [1, 1, 0], v: [0, 0.3, 1], radius: [0.2 mm, 0.3 mm]}
    velocity: [0.1, 0, 0.3]
    pin:
      - {name: left, corners: ["x- z-", z+], patch: 2, border_only: true, motion: {t: [0, 1], translate: [0, 0.1, 0]}}
      - {nodes: [12, 13]}
  - name: weave
    group: things
    material: "12"
    woven_yarns: {yarns: [6, 7], spacing: 1.44 mm, radius: 0.3 mm, weave: twill, borders: false, u: [0, 1, 0]}
    transform: {rotate: {axis: [1, 2, 3], angle: 33}, translate: [0.1, 0.2, 0.3]}
    pin: {name: right, edge: z-, patch: 2, twist: true}
  - strand: {material: wool, points: [[0, 0, 0], [0.01, 1/3, 0], [0.02, 0.4, 0]], radius: 0.3 mm}
    pin: {ball: {center: [0, 0, 0], radius: 0.01}}
  - strand: {material: wool, from: [1, 0, 0], to: [1, 0.1, 0], segments: 7, radius: 0.3 mm}
    pin: {shape: {subtract: [{box: {min: [0, 0, -1], max: [2, 0.05, 1]}}, {ball: {center: [1, 0, 0], radius: 0.01}}]}}
obstacles:
  - {name: ball, shape: {ball: {center: [5, 0, 0], radius: 0.1}}, collide: false, cohesive: false, friction_angle: 0.4 rad}
motion: {right: {t: [0, 2], rotate: {axis: [0, 0, 1], angle: 99, origin: [0, 0.1, 0]}}}
)";

std::string allFabric()
{
    std::string text = kAllFabric;
    text.replace(text.find("1/3"), 3, "0.3333333333333333");
    return text;
}

std::string everything()
{
    std::string text = kEverything;
    for (const char* third : {"1/3 m", "1/3 s"}) text.replace(text.find(third), 3, "0.3333333333333333");
    return text;
}

TEST(PrintScene, LoadsAgainToTheSame) { expectRoundTrip(sim::sceneFileFromText(everything(), "everything.yaml")); }

TEST(PrintScene, FabricLoadsAgainToTheSame) { expectRoundTrip(sim::sceneFileFromText(allFabric(), "fabric.yaml")); }

TEST(PrintScene, KeepsEveryBitOfTheFabric)
{
    const sim::Scene before = sim::readScene(sim::sceneFileFromText(allFabric(), "fabric.yaml"));
    const sim::Scene after = sim::readScene(sim::sceneFileFromText(sim::printScene(before), "printed.yaml"));
    EXPECT_EQ(before.settings.porous.volumeFraction, after.settings.porous.volumeFraction);
    EXPECT_EQ(before.settings.porous.fibreDiameter, after.settings.porous.fibreDiameter);
    EXPECT_EQ(before.settings.fabric.solver, after.settings.fabric.solver);
    EXPECT_EQ(before.settings.fabric.tolerance, after.settings.fabric.tolerance);
    EXPECT_EQ(before.settings.fabric.hingeConstant, after.settings.fabric.hingeConstant);
    EXPECT_EQ(before.obstacles.at(0).collide, after.obstacles.at(0).collide);
    EXPECT_EQ(before.obstacles[0].frictionAngle, after.obstacles[0].frictionAngle);
    ASSERT_EQ(before.fabrics.size(), after.fabrics.size());
    for (std::size_t i = 0; i < before.fabrics.size(); ++i) {
        const sim::FabricPiece &a = before.fabrics[i], &b = after.fabrics[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.group, b.group);
        EXPECT_EQ(a.materialName, b.materialName);
        EXPECT_EQ(a.material.young, b.material.young);
        EXPECT_EQ(a.material.frictionAngle, b.material.frictionAngle);
        EXPECT_EQ(a.material.sectionRotation, b.material.sectionRotation);
        EXPECT_EQ(a.material.volumeFraction, b.material.volumeFraction);
        EXPECT_EQ(a.material.dampBending, b.material.dampBending);
        EXPECT_EQ(a.radius, b.radius);
        EXPECT_EQ(a.points, b.points);
        EXPECT_EQ(a.strands, b.strands);
        EXPECT_EQ(a.faces, b.faces);
        EXPECT_EQ(a.velocity, b.velocity);
        ASSERT_EQ(a.pins.size(), b.pins.size());
        for (std::size_t k = 0; k < a.pins.size(); ++k) {
            EXPECT_EQ(a.pins[k].name, b.pins[k].name);
            EXPECT_EQ(a.pins[k].vertices, b.pins[k].vertices);
            EXPECT_EQ(a.pins[k].twist, b.pins[k].twist);
            EXPECT_EQ(a.pins[k].motion.transform(0.7) * sim::Vec3(1, 2, 3), b.pins[k].motion.transform(0.7) * sim::Vec3(1, 2, 3));
        }
    }
}

TEST(PrintScene, SmallestSceneLoadsAgainToTheSame)
{
    expectRoundTrip(
        sim::sceneFileFromText("grid: {cell: 0.1}\nliquid: {sources: [{shape: {ball: {center: [0, 0, 0], radius: 1}}}]}\n", "smallest.yaml"));
}

TEST(PrintScene, ShippedScenesLoadAgainToTheSame)
{
    for (const auto& entry : std::filesystem::recursive_directory_iterator(SCENES_DIR)) {
        if (entry.path().extension() != ".yaml") continue;
        expectRoundTrip(sim::loadSceneFile(entry.path()));
        for (const std::string& variant : sim::variantNames(entry.path())) expectRoundTrip(sim::loadSceneFile(entry.path(), {variant, {}}));
    }
}

TEST(PrintScene, KeepsEveryBitOfTheSettings)
{
    const sim::Scene before = sim::readScene(sim::sceneFileFromText(everything(), "everything.yaml"));
    const sim::Scene after = sim::readScene(sim::sceneFileFromText(sim::printScene(before), "printed.yaml"));
    EXPECT_EQ(before.settings.time.dt, after.settings.time.dt);
    EXPECT_EQ(before.settings.cell, after.settings.cell);
    EXPECT_EQ(before.settings.gravity, after.settings.gravity);
    EXPECT_EQ(before.settings.liquid.density, after.settings.liquid.density);
    EXPECT_EQ(before.settings.liquid.viscosity, after.settings.liquid.viscosity);
    EXPECT_EQ(before.settings.liquid.contactAngle, after.settings.liquid.contactAngle);
    EXPECT_EQ(before.settings.transfer.dampingPerStep, after.settings.transfer.dampingPerStep);
    EXPECT_EQ(before.title, after.title);
    EXPECT_EQ(before.tags, after.tags);
    ASSERT_EQ(before.sources.size(), after.sources.size());
    for (const sim::Vec3& x : {sim::Vec3(1, 2, 3), sim::Vec3(30, 20, -11), sim::Vec3(-5, 47, 0.5)}) {
        for (std::size_t i = 0; i < before.sources.size(); ++i) EXPECT_EQ(before.sources[i].shape.distance(x), after.sources[i].shape.distance(x));
        for (std::size_t i = 0; i < before.obstacles.size(); ++i) {
            EXPECT_EQ(before.obstacles[i].shape.distance(x), after.obstacles[i].shape.distance(x));
            EXPECT_EQ(before.obstacles[i].motion.transform(2.2) * x, after.obstacles[i].motion.transform(2.2) * x);
        }
    }
    EXPECT_EQ(before.sources[0].emissions[1].maxVolume, after.sources[0].emissions[1].maxVolume);
}

TEST(PrintScene, SaysUnitsAndHelp)
{
    const std::string text = printed(sim::sceneFileFromText(everything(), "everything.yaml"));
    EXPECT_NE(std::string::npos, text.find("# [s] Time step"));
    EXPECT_NE(std::string::npos, text.find("# [g/cm^3] Mass per volume"));
    EXPECT_NE(std::string::npos, text.find("cm^3 of liquid"));
}

TEST(PrintScene, OpeningsReadBack)
{
    expectRoundTrip(sim::sceneFileFromText(R"(
grid: {cell: 0.1}
domain: {box: {min: [0, 0, 0], max: [4, 2, 1]}}
liquid:
  sources: [{shape: {box: {min: [0, 0, 0], max: [4, 1, 1]}}}]
  openings: [{name: from, face: x-, velocity: 20, level: 1}, {face: z+, velocity: 3.5}, {name: to, face: x+, level: 1.25}]
)",
                                           "openings.yaml"));
}

TEST(PrintScene, FormulasReadBack)
{
    expectRoundTrip(sim::sceneFileFromText(R"(
grid: {cell: 0.1}
liquid:
  sources:
    - shape: {ball: {center: [0, 0, 0], radius: 1}}
      velocity_field: ["-y", "x > 0 ? sin(2 * x) : 3e-1 * z^2", 0]
)",
                                           "formulas.yaml"));
}

}  // namespace
