// What .vtp files hold, as VTK reads it.

#include "app/export/vtp.h"

#include "app/export/exporter.h"
#include "sim/surface/liquid_surface.h"
#include "tests/app/export/geometry_in_test.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace app {
namespace {

using nlohmann::json;
using sim::Vec3;
using test::expectClose;
using test::kSingle;
using test::WetScene;

const json& values(const json& part, const char* array) { return part.at("arrays").at(array).at("values"); }

/// An array of one number per point.
double number(const json& part, const char* array, std::size_t point) { return values(part, array).at(point).at(0).get<double>(); }

/// Places of a lattice in a ball around the origin [cm].
std::vector<Vec3> latticeBall(double radius, double spacing)
{
    std::vector<Vec3> places;
    const int n = static_cast<int>(radius / spacing);
    for (int k = -n; k <= n; ++k)
        for (int j = -n; j <= n; ++j)
            for (int i = -n; i <= n; ++i)
                if (const Vec3 x = spacing * Vec3(i, j, k); x.norm() <= radius) places.push_back(x);
    return places;
}

/// One part of a frame, through a file and VTK.
json written(const ExportFrame& frame, const std::string& part)
{
    const test::TemporaryFolder folder;
    Exporter(folder.path(), {}, 0.01).write(frame);
    return test::readGeometry({folder / (part + "_00000.vtp")})[0];
}

TEST(Vtp, LiquidIsReadBackInTheOrderOfItsIds)
{
    WetScene scene;
    scene.state.time = 0.1;
    const json part = written(scene.frame(), "liquid");
    const sim::LiquidParticles& liquid = scene.state.liquid;
    ASSERT_EQ(part.at("points").size(), liquid.count);
    ASSERT_EQ(part.at("verts").size(), liquid.count);
    EXPECT_EQ(part.at("time"), 0.1);
    EXPECT_EQ(part.at("arrays").at("id").at("type"), "unsigned int");
    EXPECT_EQ(part.at("arrays").size(), 4u);
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const std::size_t i = liquid.id[p] - 100;
        EXPECT_EQ(number(part, "id", i), liquid.id[p]);
        EXPECT_EQ(part.at("verts")[i], json({i}));
        expectClose(part.at("points")[i], liquid.position(p));
        expectClose(values(part, "velocity")[i], liquid.velocity(p));
        EXPECT_NEAR(number(part, "speed", i), liquid.velocity(p).norm(), kSingle * 200.0);
        EXPECT_NEAR(number(part, "volume", i), liquid.mass[p] / test::kDensity, kSingle * 3e-3);
    }
}

TEST(Vtp, YarnsAreReadBackAsLinesWithTheirRadius)
{
    const WetScene scene;
    const json part = written(scene.frame(), "yarns");
    EXPECT_EQ(part.at("lines"), json::parse("[[0, 1, 2], [3, 4]]"));
    ASSERT_EQ(part.at("points").size(), 5u);
    for (std::size_t v = 0; v < 5; ++v) {
        expectClose(part.at("points")[v], scene.state.fabric.x[v]);
        expectClose(values(part, "velocity")[v], scene.state.fabric.v[v]);
        EXPECT_NEAR(number(part, "absorbed", v), scene.state.fabric.absorbed[v], kSingle);
        EXPECT_NEAR(number(part, "radius", v), 0.06, kSingle) << "of a round yarn with the section of one of 0.04 by 0.09";
        EXPECT_EQ(number(part, "material", v), 0);
    }
}

TEST(Vtp, SaturationIsTheFullPartOfThePores)
{
    const WetScene scene;
    const std::vector<double> capacity = sim::poreCapacity(scene.fabric, test::kDensity);
    const json yarns = written(scene.frame(), "yarns"), cloth = written(scene.frame(), "cloth");
    EXPECT_EQ(number(yarns, "saturation", 1), 1.0) << "holds more than its pores do";
    int between = 0;
    for (std::size_t v = 0; v < scene.fabric.vertexCount(); ++v) {
        const double saturation = v < 5 ? number(yarns, "saturation", v) : number(cloth, "saturation", v - 5);
        EXPECT_NEAR(saturation, std::min(1.0, scene.state.fabric.absorbed[v] / capacity[v]), kSingle);
        EXPECT_GE(saturation, 0.0);
        EXPECT_LE(saturation, 1.0);
        between += saturation > 0.0 && saturation < 1.0;
    }
    EXPECT_GT(between, 3);
}

TEST(Vtp, ClothIsReadBackAsItsOwnVerticesAndFaces)
{
    const WetScene scene;
    const json part = written(scene.frame(), "cloth");
    ASSERT_EQ(part.at("points").size(), 12u) << "without those of yarns";
    ASSERT_EQ(part.at("polys").size(), scene.fabric.faces.size());
    for (std::size_t f = 0; f < scene.fabric.faces.size(); ++f)
        for (int c = 0; c < 3; ++c)
            expectClose(part.at("points")[part.at("polys")[f][c].get<std::size_t>()], scene.state.fabric.x[scene.fabric.faces.vertices[f][c]]);
    for (std::size_t i = 0; i < 12; ++i) {
        expectClose(values(part, "velocity")[i], scene.state.fabric.v[5 + i]);
        EXPECT_NEAR(number(part, "absorbed", i), scene.state.fabric.absorbed[5 + i], kSingle);
        EXPECT_EQ(number(part, "material", i), 1);
    }
}

TEST(Vtp, NormalsOfClothAreThoseOfItsFacesByArea)
{
    const WetScene scene;
    const json part = written(scene.frame(), "cloth");
    std::vector<Vec3> sums(12, Vec3::Zero());
    for (const sim::Vec3i& face : scene.fabric.faces.vertices) {
        const auto& x = scene.state.fabric.x;
        const Vec3 twiceArea = (x[face[1]] - x[face[0]]).cross(x[face[2]] - x[face[0]]);
        for (const int v : face) sums[v - 5] += 0.5 * twiceArea.norm() * twiceArea.normalized();
    }
    for (std::size_t i = 0; i < 12; ++i) {
        const json& normal = values(part, "normal")[i];
        const Vec3 n(normal[0], normal[1], normal[2]);
        EXPECT_NEAR(n.norm(), 1.0, 2.0 * kSingle);
        EXPECT_NEAR((n - sums[i].normalized()).norm(), 0.0, 1e-6);
    }
}

TEST(Vtp, ObstaclesAreReadBackByName)
{
    WetScene scene;
    FrameSnapshot::Mesh second = scene.obstacles[0];
    second.velocities.assign(4, {1.0f, -2.0f, 3.0f});
    scene.obstacles.push_back(second);
    const json still = written(scene.frame(), "obstacle_big_tank"), moving = written(scene.frame(), "obstacle_big_tank_2");
    EXPECT_EQ(still.at("polys"), json::parse("[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]"));
    expectClose(still.at("points")[2], Vec3(-5, 9, -5));
    expectClose(values(still, "velocity")[2], Vec3::Zero());
    expectClose(values(moving, "velocity")[3], Vec3(1, -2, 3));
}

/// A ball of particles that moves as a whole.
TEST(Vtp, TheSurfaceEnclosesTheLiquidAndMovesWithIt)
{
    constexpr double kSpacing = 0.1, kRadius = 0.5;
    const Vec3 velocity(10.0, -20.0, 5.0);
    WetScene scene;
    scene.state.liquid = {};
    for (const Vec3& x : latticeBall(kRadius, kSpacing))
        scene.state.liquid.add(x, test::kDensity * kSpacing * kSpacing * kSpacing, static_cast<std::uint32_t>(scene.state.liquid.count), velocity);
    sim::LiquidSurface surface;
    const auto& mesh = surface.find(scene.state.liquid, test::kDensity);
    const json part = written(exportFrame(0, scene.state, scene.fabric, test::kDensity, {}, &mesh), "surface");
    ASSERT_EQ(part.at("points").size(), mesh.positions.size());
    const auto at = [&](std::size_t i) { return Vec3(part.at("points")[i][0], part.at("points")[i][1], part.at("points")[i][2]); };
    double volume = 0.0;
    for (const json& t : part.at("polys")) volume += at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0;
    const double there = static_cast<double>(scene.state.liquid.count) * kSpacing * kSpacing * kSpacing;
    EXPECT_NEAR(volume, there, 0.02 * there);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const json& v = values(part, "velocity")[i];
        EXPECT_NEAR((Vec3(v[0], v[1], v[2]) - velocity).norm(), 0.0, 1e-3);
        const json& n = values(part, "normal")[i];
        EXPECT_NEAR(Vec3(n[0], n[1], n[2]).norm(), 1.0, 1e-5);
        EXPECT_GT(Vec3(n[0], n[1], n[2]).dot(at(i)), 0.0) << "out of the ball";
    }
}

TEST(Vtp, LiquidThatHasNotComeYetIsAFileWithTheSameArrays)
{
    const json part = written(WetScene(0).frame(), "liquid"), filled = written(WetScene(3).frame(), "liquid");
    EXPECT_EQ(part.at("points"), json::array());
    EXPECT_EQ(part.at("verts"), json::array());
    for (const auto& [name, array] : filled.at("arrays").items()) {
        ASSERT_TRUE(part.at("arrays").contains(name)) << name;
        EXPECT_EQ(part.at("arrays").at(name).at("type"), array.at("type"));
    }
}

/// Numbers enough for many blocks of the compression, and arrays that end within one and at the end of one.
TEST(Vtp, EveryParticleOfManyArrives)
{
    for (const std::size_t count : {std::size_t{16384}, std::size_t{20001}}) {
        const WetScene scene(count);
        const json part = written(scene.frame(), "liquid");
        ASSERT_EQ(part.at("points").size(), count);
        for (std::size_t p = 0; p < count; ++p) {
            const std::size_t i = scene.state.liquid.id[p] - 100;
            ASSERT_EQ(number(part, "id", i), scene.state.liquid.id[p]);
            ASSERT_EQ(part.at("points")[i][1], static_cast<float>(scene.state.liquid.x[1][p]));
        }
    }
}

}  // namespace
}  // namespace app
