// Cloth and yarns that come from files.
#include "sim/core/check.h"
#include "sim/core/units.h"
#include "sim/fabric/fabric.h"
#include "sim/scene/load_scene.h"
#include "tests/sim/scene/fabric_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>

namespace {

using sim::FabricPiece;
using sim::Scene;
using sim::Vec3;

using sim::test::kBegin, sim::test::load, sim::test::piece;

double massOf(const FabricPiece& piece)
{
    const sim::Fabric fabric = sim::assembleFabric({&piece, 1});
    return std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
}

/// A file that is there as long as this object.
struct ObjFile {
    explicit ObjFile(const std::string& text) : path(std::filesystem::temp_directory_path() / ("drench_fabric_" + std::to_string(getpid()) + ".obj"))
    {
        std::ofstream(path) << text;
    }
    ~ObjFile() { std::filesystem::remove(path); }
    ObjFile(const ObjFile&) = delete;
    ObjFile& operator=(const ObjFile&) = delete;
    std::filesystem::path path;
};

TEST(FabricFiles, MeshesAreScaledAndOrientedAlike)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n");
    const FabricPiece mesh = piece("mesh: {material: wool, radius: 0.05, scale: 2, file: " + file.path.string() + "}");
    EXPECT_EQ((std::vector<sim::Vec3i>{{0, 1, 2}, {0, 2, 3}}), mesh.faces);
    EXPECT_EQ(Vec3(2, 2, 0), mesh.points.at(2));
    EXPECT_NEAR(4.0 * 0.1 * 1.32 * 0.4, massOf(mesh), 1.0e-14);
}

TEST(FabricFiles, MeshesHaveTheUnitOfTheirScene)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    const auto sizeOf = [&](const std::string& scale) {
        return load(
                   "units: si\ngrid: {cell: 0.01}\nmaterials: {wool: {young: 1.0e+5}}\nfabrics: [{mesh: {material: wool, radius: 1 mm, "
                   "file: " +
                   file.path.string() + scale + "}}]\n")
            .fabrics.at(0)
            .points.at(1)[0];
    };
    EXPECT_DOUBLE_EQ(100.0, sizeOf(""));
    EXPECT_DOUBLE_EQ(2.0, sizeOf(", scale: 0.02"));
    EXPECT_DOUBLE_EQ(2.0, sizeOf(", scale: 2 cm"));
}

TEST(FabricFiles, VerticesAtOnePlaceAreOneUnlessTheSceneSaysOtherwise)
{
    const ObjFile file("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0.0000001\nv 0 1 0\nf 2 3 4\nf 5 6 7\n");
    const std::string begin = "mesh: {material: wool, radius: 0.05, file: " + file.path.string();
    const FabricPiece welded = piece(begin + "}"), apart = piece(begin + ", weld: 0}"), asked = piece(begin + ", weld: 2.0e-7}"),
                      wide = piece(begin + ", weld: 1 mm}");
    for (const FabricPiece& one : {welded, asked, wide}) {
        EXPECT_EQ((std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), one.points);
        EXPECT_EQ((std::vector<sim::Vec3i>{{0, 1, 2}, {0, 2, 3}}), one.faces);
        ASSERT_EQ(2u, one.notes.size());
        EXPECT_NE(std::string::npos, one.notes[0].find("1 of its vertices are in no face")) << one.notes[0];
        EXPECT_NE(std::string::npos, one.notes[1].find("2 of its vertices are welded")) << one.notes[1];
    }
    EXPECT_EQ(6u, apart.points.size());
    ASSERT_EQ(2u, apart.notes.size());
    EXPECT_NE(std::string::npos, apart.notes[1].find("2 of its 2 triangles share no vertex")) << apart.notes[1];
}

void expectError(const std::string& fabric, const std::string& part)
{
    try {
        piece(fabric);
        FAIL() << fabric << " was accepted";
    } catch (const sim::InputError& error) {
        EXPECT_NE(std::string::npos, std::string(error.what()).find(part)) << error.what();
    }
}

TEST(FabricFiles, PinsNameVerticesOfTheFile)
{
    const ObjFile file("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4\nf 5 6 7\n");
    const std::string begin = "mesh: {material: wool, radius: 0.05, file: " + file.path.string();
    EXPECT_EQ((std::vector<int>{0, 2, 3}), piece(begin + "}, pin: {nodes: [1, 4, 5, 6]}").pins.at(0).vertices);
    EXPECT_EQ((std::vector<int>{0, 3, 4, 5}), piece(begin + ", weld: 0}, pin: {nodes: [1, 4, 5, 6]}").pins.at(0).vertices);
    expectError(begin + "}, pin: {nodes: [0]}", "nothing of the file is at its vertex 0");
    expectError(begin + "}, pin: {nodes: [7]}", "nodes");
    expectError(begin + ", weld: 5}", "leaves no triangle");
}

/// Whatever is wrong is at the vertices that the file's own numbers name, counted from 0 as for pins.
TEST(FabricFiles, MistakesNameVerticesOfTheFile)
{
    // Two triangles whose common corners are there twice, after a vertex that nothing uses.
    const std::string sheet = "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4\nf 5 6 7\n";
    const auto mesh = [](const ObjFile& file) { return "mesh: {material: wool, radius: 0.05, file: " + file.path.string() + "}"; };
    const ObjFile flat(sheet + "v 5 5 5\nv 6 6 6\nv 7 7 7\nf 8 9 10\n");
    expectError(mesh(flat), "the face 7, 8, 9 has no area");
    const ObjFile threeFaces(sheet + "v 0 0 0\nv 1 1 0\nv 0 0 1\nf 8 9 10\n");
    expectError(mesh(threeFaces), "between vertices 1 and 3 has more than two faces");
    const ObjFile line("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 0 0\nl 2 3 4\n");
    expectError("points: {material: wool, radius: 0.05, file: " + line.path.string() + "}", "turns straight back at vertex 2");
    const ObjFile sound(sheet);
    EXPECT_EQ((std::vector<int>{1, 2, 3, 6}), piece(mesh(sound)).inFile);
    expectError(mesh(sound) + ", pin: [{nodes: [6]}, {nodes: [6], motion: [{t: [0, 1], translate: [0, 1, 0]}]}]", "vertex 6 is held by two pins");
}

/// Triangles of a sheet in any order, each with its own corners, are one sheet again.
TEST(FabricFiles, ASoupOfTrianglesIsOneSheet)
{
    for (const double size : {1.0e-2, 1.0, 300.0}) {
        constexpr int kCells = 5;
        std::string text, faces;
        int corners = 0;
        for (int n = 0; n < 2 * kCells * kCells; ++n) {
            const int cell = (n * 7) % (2 * kCells * kCells), i = cell / 2 % kCells, j = cell / 2 / kCells;
            const std::array<std::array<int, 2>, 3> ends = cell % 2 ? std::array<std::array<int, 2>, 3>{{{i, j}, {i + 1, j}, {i + 1, j + 1}}}
                                                                    : std::array<std::array<int, 2>, 3>{{{i + 1, j + 1}, {i, j + 1}, {i, j}}};
            for (const auto& [a, b] : ends)
                text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", static_cast<float>(size * 0.3 * a), 0.0, static_cast<float>(size * 0.3 * b));
            faces += fmt::format("f {} {} {}\n", corners + 1, corners + 2, corners + 3);
            corners += 3;
        }
        const ObjFile file(text + faces);
        const FabricPiece sheet = piece("mesh: {material: wool, radius: 1.0e-4, file: " + file.path.string() + "}");
        EXPECT_EQ((kCells + 1) * (kCells + 1), static_cast<int>(sheet.points.size()));
        EXPECT_EQ(2 * kCells * kCells, static_cast<int>(sheet.faces.size()));
        ASSERT_EQ(1u, sheet.notes.size());
        EXPECT_NE(std::string::npos, sheet.notes[0].find(fmt::format("{} of its vertices are welded", corners - 36))) << sheet.notes[0];
    }
}

TEST(FabricFiles, LinesOfAFileAreYarns)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nl 1 2 3\nl 2 -1\n");
    const FabricPiece net = piece("points: {material: wool, radius: 0.05, file: " + file.path.string() + "}");
    EXPECT_TRUE(net.notes.empty());
    EXPECT_EQ((std::vector<std::vector<int>>{{0, 1, 2}, {1, 3}}), net.strands);
    EXPECT_NEAR(3.0 * sim::kPi * 0.05 * 0.05 * 1.32 * 0.4, massOf(net), 1.0e-15);
}

TEST(FabricFiles, PointsOfNoLineAreLeftOut)
{
    const ObjFile file("v 9 0 0\nv 0 0 0\nv 1 0 0\nv 9 9 0\nv 2 0 0\nv 2 0 0\nl 2 3 5\n");
    const FabricPiece yarn = piece("points: {material: wool, radius: 0.05, file: " + file.path.string() + "}, pin: {nodes: [2, 4]}");
    EXPECT_EQ((std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), yarn.points);
    EXPECT_EQ((std::vector<int>{1, 2}), yarn.pins.at(0).vertices);
    ASSERT_EQ(1u, yarn.notes.size());
    EXPECT_NE(std::string::npos, yarn.notes[0].find("3 of its vertices are in no line")) << yarn.notes[0];
}

}  // namespace
