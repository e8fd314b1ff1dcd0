#include "app/scene/read_picture_settings.h"

#include <gtest/gtest.h>

namespace {

app::PictureSettings read(const std::string& text) { return app::readPictureSettings(sim::sceneFileFromText(text, "good.yaml")); }

TEST(PictureSettings, AreDefaultsWhereTheSceneSaysNothing)
{
    const app::PictureSettings settings = read("grid: {cell: 1}\n"), defaults;
    EXPECT_EQ(defaults.render.width, settings.render.width);
    EXPECT_EQ(defaults.render.liquidStyle, settings.render.liquidStyle);
    EXPECT_TRUE(settings.render.camera.autoFrame);
    EXPECT_EQ(defaults.output.every, settings.output.every);
    EXPECT_TRUE(settings.compare.variants.empty());
    EXPECT_FALSE(settings.output.geometry);
    EXPECT_TRUE(settings.output.geometryFormats.vtp);
    EXPECT_FALSE(settings.output.geometryFormats.usda);
}

TEST(PictureSettings, EnergiesThatAreNotKeptAreNotDrawn)
{
    const std::string variants = "compare: {variants: {transfer.method: [pic, apic]}}\n";
    EXPECT_TRUE(read(variants).compare.energyPlot);
    EXPECT_FALSE(read("output: {data: [states]}\n" + variants).compare.energyPlot);
}

TEST(PictureSettings, GeometryIsPrintedAsItIsRead)
{
    const app::PictureSettings s = read("output: {data: [geometry], geometry_format: [ply, usda]}\n");
    const std::string printed = app::printPictureSettings(s);
    for (const app::OutputSettings& output : {s.output, read(printed).output}) {
        EXPECT_TRUE(output.geometry);
        EXPECT_FALSE(output.energy);
        EXPECT_FALSE(output.geometryFormats.vtp);
        EXPECT_TRUE(output.geometryFormats.ply);
        EXPECT_FALSE(output.geometryFormats.obj);
        EXPECT_TRUE(output.geometryFormats.usda);
    }
    EXPECT_NE(printed.find("geometry_format: [ply, usda]"), std::string::npos) << printed;
}

TEST(PictureSettings, AllArrive)
{
    const app::PictureSettings s = read(R"(
render:
  size: [640, 480]
  background: [0, 0.5, 1]
  camera: {look_at: [1, 2, 3], eye: [4, 5, 6], up: [0, 0, 1], fov: 50}
  liquid: {style: points, color_by: flat, colormap: turbo, range: [1, 2]}
  obstacles: {style: wire, opacity: 0.5}
  hud: false
  colorbar: false
  samples: 8
output: {dir: here, every: 2 ms, frames: none, data: [energy], video: {fps: 25, codec: libx265}}
compare: {name: all, variants: {transfer.method: [pic, apic]}, layout: rows, products: [sheet, table], reference: pic}
)");
    EXPECT_EQ(640, s.render.width);
    EXPECT_EQ(480, s.render.height);
    EXPECT_EQ(0.5f, s.render.background[1]);
    EXPECT_FALSE(s.render.camera.autoFrame);
    EXPECT_EQ(Eigen::Vector3d(4, 5, 6), s.render.camera.eye);
    EXPECT_EQ(Eigen::Vector3d(0, 0, 1), s.render.camera.up);
    EXPECT_EQ(50.0, s.render.camera.fovDegrees);
    EXPECT_EQ(app::LiquidStyle::Points, s.render.liquidStyle);
    EXPECT_EQ(app::ColorBy::Flat, s.render.colorBy);
    EXPECT_EQ(app::ColorMap::Turbo, s.render.colorMap);
    EXPECT_EQ(2.0, s.render.range[1]);
    EXPECT_EQ(app::ObstacleStyle::Wire, s.render.obstacleStyle);
    EXPECT_FALSE(s.render.hud);
    EXPECT_EQ(8, s.render.samples);
    EXPECT_EQ("here", s.output.dir);
    EXPECT_EQ(2.0e-3, s.output.every);
    EXPECT_FALSE(s.output.frames);
    EXPECT_TRUE(s.output.energy);
    EXPECT_FALSE(s.output.stats);
    EXPECT_EQ("libx265", s.output.videoCodec);
    ASSERT_EQ(2u, s.compare.variants.size());
    EXPECT_EQ("apic", s.compare.variants[1].name);
    EXPECT_EQ((std::vector<std::string>{"transfer.method=apic"}), s.compare.variants[1].overrides);
    EXPECT_EQ(app::CompareLayout::Rows, s.compare.layout);
    EXPECT_FALSE(s.compare.video);
    EXPECT_TRUE(s.compare.sheet);
    EXPECT_EQ("pic", s.compare.reference);
}

TEST(PictureSettings, LooksOfFabricArrive)
{
    const app::RenderSettings r = read(R"(
units: si
render:
  yarns: {color_by: speed, colormap: turbo, range: [0, 2], tube_sides: 12}
  cloth: {color: [1, 0.5, 0], wet_color: [0, 0, 1]}
  obstacles: {style: solid}
)")
                                      .render;
    EXPECT_EQ(app::FabricColorBy::Speed, r.yarns.colorBy);
    EXPECT_EQ(app::ColorMap::Turbo, r.yarns.colorMap);
    EXPECT_EQ(200.0, r.yarns.range[1]);
    EXPECT_EQ(12, r.yarns.tubeSides);
    EXPECT_TRUE(r.cloth.ownColor);
    EXPECT_EQ(0.5f, r.cloth.color[1]);
    EXPECT_EQ(app::ObstacleStyle::Solid, r.obstacleStyle);
}

TEST(PictureSettings, StrainHasARangeOfItsOwnWithoutUnit)
{
    const app::RenderSettings wet = read("render: {cloth: {color_by: saturation}}\n").render;
    EXPECT_EQ(app::FabricColorBy::Saturation, wet.cloth.colorBy);
    EXPECT_EQ((std::array{0.0, 1.0}), wet.cloth.range);
    const app::RenderSettings r = read("units: si\nrender: {yarns: {color_by: strain}, cloth: {color_by: strain, range: [0, 0.5]}}\n").render;
    EXPECT_EQ(0.1, r.yarns.range[1]);
    EXPECT_EQ(0.5, r.cloth.range[1]);
    EXPECT_FALSE(r.yarns.ownColor);
}

TEST(PictureSettings, PressureHasARangeOfItsOwnInItsUnit)
{
    const app::RenderSettings usual = read("render: {liquid: {color_by: pressure}}\n").render;
    EXPECT_EQ(app::ColorBy::Pressure, usual.colorBy);
    EXPECT_EQ((std::array{0.0, 1.0e4}), usual.range);
    const app::RenderSettings si = read("units: si\nrender: {liquid: {range: [-10, 500], color_by: pressure}}\n").render;
    EXPECT_EQ((std::array{-100.0, 5000.0}), si.range) << "pascals, wherever the key stands";
    EXPECT_EQ((std::array{0.0, 200.0}), read("render: {liquid: {color_by: speed}}\n").render.range);
}

TEST(PictureSettings, OrbitIsACameraOfItsOwn)
{
    const app::CameraSettings c =
        read("render: {camera: {orbit: {target: [1, 2, 3], distance: 9, azimuth: 20, elevation: 10, turn_per_s: 5}}}\n").render.camera;
    EXPECT_TRUE(c.orbit);
    EXPECT_FALSE(c.autoFrame);
    EXPECT_EQ(Eigen::Vector3d(1, 2, 3), c.lookAt);
    EXPECT_EQ(20.0, c.azimuthDegrees);
    EXPECT_EQ(5.0, c.turnDegreesPerSecond);
}

TEST(PictureSettings, LengthsFollowTheUnitsOfTheFile)
{
    const app::RenderSettings r = read("units: si\nrender: {camera: {look_at: [0, 0, 0], eye: [0, 0, 1]}, liquid: {range: [0, 2]}}\n").render;
    EXPECT_EQ(100.0, r.camera.eye[2]);
    EXPECT_EQ(200.0, r.range[1]);
}

TEST(PictureSettings, VariantsThemselvesAreGivenAsOverrides)
{
    const app::CompareSettings c = read(R"(
compare:
  variants:
    - {label: "Best of all", transfer: {method: apic, modes: 4}, liquid.sources.a.velocity: [1, 2, 3], scene.title: "a: b"}
)")
                                       .compare;
    EXPECT_EQ("best_of_all", c.variants[0].name);
    EXPECT_EQ((std::vector<std::string>{"transfer={method: apic, modes: 4}", "liquid.sources.a.velocity=[1, 2, 3]", "scene.title=\"a: b\""}),
              c.variants[0].overrides);
}

}  // namespace
