// What .ply, .obj and .usda files hold, as others read them.

#include "app/export/exporter.h"
#include "app/export/geometry_files.h"
#include "tests/app/export/geometry_in_test.h"
#include "tests/app/temporary_folder.h"

#include <gtest/gtest.h>

namespace app {
namespace {

using nlohmann::json;
using sim::Vec3;
using test::expectClose;
using test::kSingle;
using test::TemporaryFolder;
using test::WetScene;

json vectorAt(const json& vertex, const char* x, const char* y, const char* z, std::size_t i)
{
    return {vertex.at(x)[i], vertex.at(y)[i], vertex.at(z)[i]};
}

class Ply : public testing::Test {
 protected:
    json read(const std::string& part)
    {
        Exporter(folder.path(), {.vtp = false, .ply = true}, 0.01).write(scene.frame());
        return test::readGeometry({folder / (part + "_00000.ply")})[0];
    }
    const TemporaryFolder folder;
    WetScene scene;
};

TEST_F(Ply, LiquidHasVelocitySpeedVolumeAndId)
{
    scene.state.time = 0.25;
    const json part = read("liquid"), vertex = part.at("vertex");
    EXPECT_EQ(part.at("time"), 0.25);
    const sim::LiquidParticles& liquid = scene.state.liquid;
    ASSERT_EQ(part.at("points").size(), liquid.count);
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const std::size_t i = liquid.id[p] - 100;
        expectClose(part.at("points")[i], liquid.position(p));
        expectClose(vectorAt(vertex, "x", "y", "z", i), liquid.position(p));
        expectClose(vectorAt(vertex, "vx", "vy", "vz", i), liquid.velocity(p));
        EXPECT_NEAR(vertex.at("speed")[i].get<double>(), liquid.velocity(p).norm(), kSingle * 200.0);
        EXPECT_NEAR(vertex.at("volume")[i].get<double>(), liquid.mass[p] / test::kDensity, kSingle * 3e-3);
        EXPECT_EQ(vertex.at("id")[i], liquid.id[p]);
    }
}

TEST_F(Ply, ClothHasFacesNormalsAndSaturation)
{
    const json part = read("cloth"), vertex = part.at("vertex");
    ASSERT_EQ(part.at("polys").size(), scene.fabric.faces.size());
    EXPECT_EQ(part.at("polys")[0], json::parse("[0, 4, 1]"));
    const ExportFrame frame = scene.frame();
    const ExportPart& cloth = frame.parts[2];
    const auto& normals = std::get<std::vector<float>>(cloth.find("normal")->values);
    for (std::size_t i = 0; i < 12; ++i) {
        const json normal = vectorAt(vertex, "nx", "ny", "nz", i);
        EXPECT_EQ(normal, json({normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}));
        EXPECT_EQ(part.at("arrays").at("Normals").at("values")[i], normal) << "VTK finds it too";
        EXPECT_EQ(vertex.at("saturation")[i], std::get<std::vector<float>>(cloth.find("saturation")->values)[i]);
        EXPECT_EQ(vertex.at("material")[i], 1);
    }
}

TEST_F(Ply, YarnsAreEdges)
{
    const json part = read("yarns");
    EXPECT_EQ(part.at("edge"), json::parse(R"({"vertex1": [0, 1, 3], "vertex2": [1, 2, 4]})"));
    EXPECT_NEAR(part.at("vertex").at("radius")[3].get<double>(), 0.06, kSingle);
    expectClose(part.at("points")[2], scene.state.fabric.x[2]);
}

TEST(Obj, HasEveryPartWithNumbersThatCountOn)
{
    const TemporaryFolder folder;
    const WetScene scene;
    Exporter(folder.path(), {.vtp = false, .obj = true}, 0.01).write(scene.frame());
    const json read = test::readGeometry({folder / "frame_00000.obj"})[0];
    const auto point = [&](const json& index) { return read.at("points")[index.get<std::size_t>()]; };
    ASSERT_EQ(read.at("verts").size(), 7u);
    ASSERT_EQ(read.at("lines").size(), 2u);
    ASSERT_EQ(read.at("polys").size(), 12u + 4u);
    for (std::size_t p = 0; p < 7; ++p) expectClose(point(read.at("verts")[scene.state.liquid.id[p] - 100][0]), scene.state.liquid.position(p));
    for (std::size_t i = 0; i < 3; ++i) expectClose(point(read.at("lines")[0][i]), scene.state.fabric.x[i]);
    for (std::size_t f = 0; f < 12; ++f)
        for (int c = 0; c < 3; ++c) expectClose(point(read.at("polys")[f][c]), scene.state.fabric.x[scene.fabric.faces.vertices[f][c]]);
    const std::string text = test::contentOf(folder / "frame_00000.obj");
    for (const char* group : {"\ng liquid\n", "\ng yarns\n", "\ng cloth\n", "\ng obstacle_big_tank\n"})
        EXPECT_NE(text.find(group), std::string::npos) << group;
}

class Usda : public testing::Test {
 protected:
    Usda()
    {
        Exporter exporter(folder.path(), {.vtp = false, .usda = true}, 0.004);
        for (int frame = 0; frame < 3; ++frame) exporter.write(WetScene(3 + frame).frame(frame));
        const json read = test::readGeometry({folder / "animation.usda", folder / "topology.usda", folder / "frame_00002.usda"});
        animation = read[0], topology = read[1], frame2 = read[2];
    }
    const json& attribute(const std::string& prim, const std::string& name) const
    {
        return frame2.at("prims").at("/drench/" + prim).at("attributes").at(name);
    }
    const json& sample(const std::string& prim, const std::string& name) const { return attribute(prim, name).at("samples").at("2"); }

    const TemporaryFolder folder;
    const WetScene last{5};
    json animation, topology, frame2;
};

TEST_F(Usda, LayersSayTheirUnitsAndTimes)
{
    for (const json& layer : {animation, topology, frame2}) {
        EXPECT_EQ(layer.at("metadata").at("metersPerUnit"), 0.01);
        EXPECT_EQ(layer.at("metadata").at("upAxis"), "Y");
        EXPECT_EQ(layer.at("metadata").at("defaultPrim"), "drench");
        EXPECT_EQ(layer.at("metadata").at("timeCodesPerSecond"), 250);
        EXPECT_TRUE(layer.at("prims").contains("/drench"));
    }
    EXPECT_EQ(animation.at("metadata").at("startTimeCode"), 0);
    EXPECT_EQ(animation.at("metadata").at("endTimeCode"), 2);
    EXPECT_EQ(frame2.at("metadata").at("startTimeCode"), 2);
}

TEST_F(Usda, TheAnimationPlaysOneClipPerFrame)
{
    const json clips = animation.at("prims").at("/drench").at("metadata").at("clips").at("default");
    EXPECT_EQ(clips.at("assetPaths"), json({"./frame_00000.usda", "./frame_00001.usda", "./frame_00002.usda"}));
    EXPECT_EQ(clips.at("active"), json::parse("[[0, 0], [1, 1], [2, 2]]"));
    EXPECT_EQ(clips.at("times"), json::parse("[[0, 0], [1, 1], [2, 2]]"));
    EXPECT_EQ(clips.at("primPath"), "/drench");
    EXPECT_EQ(clips.at("manifestAssetPath"), "./topology.usda");
    EXPECT_EQ(animation.at("metadata").at("subLayers"), json({"./topology.usda"}));
    for (const json& file : clips.at("assetPaths")) EXPECT_TRUE(std::filesystem::exists(folder.path() / file.get<std::string>()));
}

/// What varies has samples in the frames and none below the clips, where it would hide them.
TEST_F(Usda, TheTopologyDeclaresWhatFramesSample)
{
    ASSERT_EQ(topology.at("prims").size(), frame2.at("prims").size());
    for (const auto& [path, prim] : frame2.at("prims").items()) {
        const json& declared = topology.at("prims").at(path);
        EXPECT_EQ(declared.at("type"), prim.at("type"));
        ASSERT_EQ(declared.at("attributes").size(), prim.at("attributes").size());
        for (const auto& [name, attribute] : prim.at("attributes").items()) {
            const json& plain = declared.at("attributes").at(name);
            EXPECT_EQ(plain.at("type"), attribute.at("type"));
            EXPECT_EQ(plain.at("metadata"), attribute.at("metadata"));
            EXPECT_FALSE(plain.contains("samples"));
            EXPECT_EQ(plain.contains("value"), attribute.at("uniform"));
            EXPECT_EQ(attribute.contains("samples"), !attribute.at("uniform")) << path << name;
        }
    }
}

TEST_F(Usda, LiquidIsPointsWithVelocitiesWidthsAndIds)
{
    EXPECT_EQ(frame2.at("prims").at("/drench/liquid").at("type"), "Points");
    ASSERT_EQ(sample("liquid", "points").size(), 5u);
    const sim::LiquidParticles& liquid = last.state.liquid;
    for (std::size_t p = 0; p < 5; ++p) {
        const std::size_t i = liquid.id[p] - 100;
        expectClose(sample("liquid", "points")[i], liquid.position(p));
        expectClose(sample("liquid", "velocities")[i], liquid.velocity(p));
        EXPECT_EQ(sample("liquid", "ids")[i], liquid.id[p]);
        const double radius = 0.5 * sample("liquid", "widths")[i].get<double>();
        EXPECT_NEAR(4.0 / 3.0 * sim::kPi * radius * radius * radius, liquid.mass[p] / test::kDensity, 1e-8);
        for (int a = 0; a < 3; ++a) {
            EXPECT_LE(sample("liquid", "extent")[0][a].get<double>(), liquid.position(p)[a] - 0.99 * radius);
            EXPECT_GE(sample("liquid", "extent")[1][a].get<double>(), liquid.position(p)[a] + 0.99 * radius);
        }
    }
}

TEST_F(Usda, FabricIsCurvesAndAMesh)
{
    EXPECT_EQ(frame2.at("prims").at("/drench/yarns").at("type"), "BasisCurves");
    EXPECT_EQ(sample("yarns", "curveVertexCounts"), json({3, 2}));
    EXPECT_EQ(attribute("yarns", "type").at("value"), "linear");
    EXPECT_NEAR(sample("yarns", "widths")[4].get<double>(), 0.12, kSingle);
    EXPECT_EQ(sample("yarns", "primvars:saturation")[1], 1);
    EXPECT_EQ(frame2.at("prims").at("/drench/cloth").at("type"), "Mesh");
    EXPECT_EQ(attribute("cloth", "subdivisionScheme").at("value"), "none");
    EXPECT_EQ(sample("cloth", "faceVertexCounts"), json(std::vector<int>(12, 3)));
    ASSERT_EQ(sample("cloth", "faceVertexIndices").size(), 36u);
    for (const char* each : {"points", "velocities", "normals", "primvars:saturation", "primvars:absorbed", "primvars:material"})
        EXPECT_EQ(sample("cloth", each).size(), 12u) << each;
    for (std::size_t f = 0; f < 12; ++f)
        for (std::size_t c = 0; c < 3; ++c)
            expectClose(sample("cloth", "points")[sample("cloth", "faceVertexIndices")[3 * f + c].get<std::size_t>()],
                        last.state.fabric.x[last.fabric.faces.vertices[f][c]]);
    for (std::size_t i = 0; i < 12; ++i) expectClose(sample("cloth", "velocities")[i], last.state.fabric.v[5 + i]);
    EXPECT_EQ(frame2.at("prims").at("/drench/obstacle_big_tank").at("type"), "Mesh");
}

}  // namespace
}  // namespace app
