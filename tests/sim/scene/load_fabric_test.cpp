#include "sim/core/check.h"
#include "sim/core/units.h"
#include "sim/fabric/fabric.h"
#include "sim/scene/load_scene.h"

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

Scene load(const std::string& text, const std::vector<std::string>& set = {})
{
    return sim::readScene(sim::sceneFileFromText(text, "good.yaml", {"", set}));
}

const std::string kBegin =
    "grid: {cell: 0.1}\nmaterials: {wool: {young: 6.6e+7, density: 1.32, volume_fraction: 0.4}}\n";

FabricPiece piece(const std::string& text)
{
    return load(kBegin + "fabrics: [{name: it, " + text + "}]\n").fabrics.at(0);
}

const std::string kSheet = "cloth_grid: {material: wool, nodes: [5, 4], spacing: 1, radius: 0.1}";

std::vector<int> pinned(const std::string& pin, const std::string& shape = kSheet)
{
    return piece(shape + ", pin: " + pin).pins.at(0).vertices;
}

double massOf(const FabricPiece& piece)
{
    const sim::Fabric fabric = sim::assembleFabric({&piece, 1});
    return std::accumulate(fabric.mass.begin(), fabric.mass.end(), 0.0);
}

TEST(LoadFabric, PublishedClothHasItsCountsAndPins)
{
    const FabricPiece cloth = piece(
        "cloth_grid: {material: wool, nodes: [99, 99], spacing: 0.144, origin: [0, 0, 0], u: [1, 0, 0], v: [0, 0, 1], "
        "radius: [0.0165, 0.018]}, pin: {corners: [\"x- z-\", \"x- z+\"], patch: 2}");
    EXPECT_EQ(9801u, cloth.points.size());
    EXPECT_EQ(19208u, cloth.faces.size());
    const int top = 97 * 99, last = 98 * 99;
    EXPECT_EQ((std::vector<int>{0, 1, 99, 100, top, top + 1, last, last + 1}), cloth.pins.at(0).vertices);
    EXPECT_NEAR(14.112 * 14.112 * 0.0345 * 1.32 * 0.4, massOf(cloth), 1.0e-10);
}

TEST(LoadFabric, PublishedYarnsHaveTheirCountsAndPins)
{
    const FabricPiece cloth = piece(
        "woven_yarns: {material: wool, yarns: [100, 100], spacing: 0.144, origin: [0, 0, 0], amplitude: 0.072, "
        "radius: [0.048, 0.018], weave: herringbone, borders: true}, pin: {corners: all, patch: 2, border_only: true}");
    EXPECT_EQ(19604u, cloth.points.size());
    EXPECT_EQ(200u, cloth.strands.size());
    // Both ends of the first and last yarn of each direction, and the corners.
    EXPECT_EQ((std::vector<int>{0, 99, 9700, 9799, 9800, 9899, 19500, 19599, 19600, 19601, 19602, 19603}),
              cloth.pins.at(0).vertices);
}

TEST(LoadFabric, MaterialTakesWhatTheSceneSaysAndThePorousFraction)
{
    const Scene scene = load(R"(
grid: {cell: 0.1}
porous: {fibre_diameter: 0.02, pore_radius: 0.01}
materials:
  wool: {young: 6.6 MPa, poisson: 0.3, density: 1.4, damping_viscosity: 5, damp_bending: false, damp_stretching: false,
         stretch_factor: 2, contact_stiffness: 0.03, pin_stiffness: 0.04, friction_angle: 45, section_rotation: 90}
  tight: {young: 1, volume_fraction: 0.9}
fabrics:
  - material: wool
    strand: {from: [0, 0, 0], to: [0, 1, 0], segments: 3, radius: [0.2, 0.1]}
    velocity: [1, 2, 3]
    group: all
)");
    const sim::FabricMaterial& m = scene.fabrics.at(0).material;
    EXPECT_DOUBLE_EQ(6.6e7, m.young);
    EXPECT_EQ(0.3, m.poisson);
    EXPECT_EQ(1.4, m.density);
    EXPECT_EQ(5.0, m.dampingViscosity);
    EXPECT_FALSE(m.dampBending || m.dampStretching);
    EXPECT_EQ(2.0, m.stretchFactor);
    EXPECT_EQ(0.03, m.contactStiffness);
    EXPECT_EQ(0.04, m.pinStiffness);
    EXPECT_DOUBLE_EQ(sim::kPi / 4.0, m.frictionAngle);
    EXPECT_DOUBLE_EQ(0.5, m.volumeFraction);
    EXPECT_DOUBLE_EQ(sim::kPi / 2.0, m.sectionRotation);
    EXPECT_EQ(0.9, scene.materials.at(1).material.volumeFraction);
    EXPECT_DOUBLE_EQ(0.01, scene.settings.porous.poreRadius());
    const FabricPiece& strand = scene.fabrics[0];
    EXPECT_EQ((std::array{0.2, 0.1}), strand.radius);
    EXPECT_EQ(Vec3(1, 2, 3), strand.velocity);
    EXPECT_EQ("all", strand.group);
    EXPECT_EQ("wool", strand.materialName);
    EXPECT_EQ("good.yaml:9", strand.where);
}

TEST(LoadFabric, PorousFollowsFromAnyTwo)
{
    const auto porous = [](const std::string& text) {
        return load(kBegin + "porous: " + text + "\nfabrics: [{" + kSheet + "}]\n").settings.porous;
    };
    const sim::PorousSettings reference = porous("{fibre_diameter: 0.01, volume_fraction: 0.4}");
    EXPECT_NEAR(0.005 * std::sqrt(1.5), reference.poreRadius(), 1.0e-15);
    EXPECT_NEAR(0.01, porous("{volume_fraction: 0.4, pore_radius: 0.006123724356957945}").fibreDiameter, 1.0e-14);
    EXPECT_NEAR(0.4, porous("{fibre_diameter: 0.01, pore_radius: 0.006123724356957945}").volumeFraction, 1.0e-14);
    // The thread counts of the pore tests; half the thickness is 0.018.
    EXPECT_NEAR(0.1745, porous("{fibre_diameter: 0.01, thread_count: 80, thickness: 0.036}").volumeFraction, 5.0e-5);
    EXPECT_NEAR(0.00191, porous("{fibre_diameter: 0.01, thread_count: 400, thickness: 0.036}").poreRadius(), 5.0e-6);
}

TEST(LoadFabric, SolverSettingsArrive)
{
    const Scene scene = load(kBegin + "fabrics: [{" + kSheet + R"(}]
fabric: {solver: grid, membrane: neo_hookean, bending: hinge, hinge: {constant: 3, measure: tan}, torsion: polar, twist: false,
         newton: 7, tolerance: 1.0e-4, contact: false, max_halvings: 2}
contact: {obstacle_young: 1.0e+5, obstacle_thickness: 0.5}
)");
    const sim::FabricSettings& f = scene.settings.fabric;
    EXPECT_EQ(sim::FabricSolver::Grid, f.solver);
    EXPECT_EQ(sim::MembraneModel::NeoHookean, f.membrane);
    EXPECT_EQ(sim::BendingModel::Hinge, f.bending);
    EXPECT_EQ(3.0, f.hingeConstant);
    EXPECT_EQ(sim::HingeMeasure::Tan, f.hingeMeasure);
    EXPECT_EQ(sim::TorsionModel::Polar, f.torsion);
    EXPECT_FALSE(f.twist);
    EXPECT_EQ(7, f.newton);
    EXPECT_EQ(1.0e-4, f.tolerance);
    EXPECT_FALSE(f.contact);
    EXPECT_EQ(2, f.maxHalvings);
}

TEST(LoadFabric, ObstaclesSayHowFabricMeetsThem)
{
    const Scene scene = load(kBegin + "fabrics: [{" + kSheet + R"(}]
obstacles:
  - {name: rough, shape: {ball: {center: [0, -3, 0], radius: 1}}, friction_angle: 45}
  - {name: ghost, shape: {ball: {center: [0, 3, 0], radius: 1}}, collide: false}
)");
    EXPECT_DOUBLE_EQ(sim::kPi / 4.0, scene.obstacles.at(0).frictionAngle.value());
    EXPECT_TRUE(scene.obstacles[0].collide);
    EXPECT_FALSE(scene.obstacles.at(1).collide);
    EXPECT_FALSE(scene.obstacles[1].frictionAngle.has_value());
}

TEST(LoadFabric, SizeAndCenterMeanTheSameAsSpacingAndOrigin)
{
    const FabricPiece a =
        piece("cloth_grid: {material: wool, nodes: [5, 3], spacing: [0.5, 2], radius: 0.1, origin: [-1, 7, -2]}");
    const FabricPiece b =
        piece("cloth_grid: {material: wool, nodes: [5, 3], size: [2, 4], radius: 0.1, center: [0, 7, 0]}");
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_TRUE(a.points[i].isApprox(b.points[i], 1.0e-14)) << i;
}

TEST(LoadFabric, TransformTurnsAboutTheMiddleThenMoves)
{
    const FabricPiece still = piece(kSheet);
    const FabricPiece moved =
        piece(kSheet + ", transform: {translate: [10, 0, 0], rotate: {axis: [0, 0, 1], angle: 90}}");
    const Vec3 middle(2.0, 0.0, 1.5);
    for (std::size_t i = 0; i < still.points.size(); ++i) {
        const Vec3 d = still.points[i] - middle;
        EXPECT_TRUE((middle + Vec3(10.0 - d[1], d[0], d[2])).isApprox(moved.points[i], 1.0e-13)) << i;
    }
    EXPECT_NEAR(massOf(still), massOf(moved), 1.0e-12);
    const FabricPiece about = piece(kSheet + ", transform: {rotate: {axis: [0, 0, 1], angle: 90, origin: [0, 0, 0]}}");
    EXPECT_TRUE(Vec3(0, 4, 0).isApprox(about.points[4], 1.0e-13));
}

TEST(LoadFabric, PinsSelectWhatTheySay)
{
    // Vertices 0-4 lie along x at z = 0, then 5-9, 10-14 and 15-19.
    EXPECT_EQ((std::vector<int>{0, 4, 15, 19}), pinned("{corners: all}"));
    EXPECT_EQ((std::vector<int>{0}), pinned("{corners: [\"x- z-\"]}"));
    EXPECT_EQ((std::vector<int>{15, 19}), pinned("{corners: [z+]}"));
    EXPECT_EQ((std::vector<int>{3, 4, 8, 9}), pinned("{corners: [\"x+ z-\"], patch: 2}"));
    EXPECT_EQ((std::vector<int>{3, 4, 9}), pinned("{corners: [\"z- x+\"], patch: 2, border_only: true}"));
    EXPECT_EQ((std::vector<int>{0, 5, 10, 15}), pinned("{edge: x-}"));
    EXPECT_EQ((std::vector<int>{10, 11, 12, 13, 14, 15, 16, 17, 18, 19}), pinned("{edge: z+, patch: 2}"));
    EXPECT_EQ((std::vector<int>{3, 7}), pinned("{nodes: [7, 3, 7]}"));
    EXPECT_EQ((std::vector<int>{0, 1, 5}), pinned("{ball: {center: [0, 0, 0], radius: 1}}"));
    EXPECT_EQ((std::vector<int>{0, 1, 5, 6}), pinned("{box: {min: [-1, -1, -1], max: [1, 1, 1]}}"));
    EXPECT_EQ((std::vector<int>{0, 1}), pinned("{shape: {capsule: {a: [0, 0, 0], b: [1, 0, 0], radius: 0.5}}}"));
}

TEST(LoadFabric, CornersTravelWithThePieceAndShapesDoNot)
{
    const std::string moved = kSheet + ", transform: {translate: [100, 0, 0], rotate: {axis: [0, 1, 0], angle: 180}}";
    EXPECT_EQ((std::vector<int>{0}), pinned("{corners: [\"x- z-\"]}", moved));
    EXPECT_EQ((std::vector<int>{19}), pinned("{ball: {center: [100, 0, 0], radius: 0.5}}", moved));
}

TEST(LoadFabric, HangingSheetIsHeldByItsUpperRows)
{
    const std::vector<int> rows =
        pinned("{edge: y+, patch: 2}",
               "cloth_grid: {material: wool, nodes: [179, 9], spacing: 0.144, radius: 0.0165, "
               "origin: [0, 2.88, 0], u: [0, 1, 0], v: [0, 0, 1]}");
    ASSERT_EQ(18u, rows.size());
    EXPECT_EQ(177, rows[0]);
    EXPECT_EQ(178, rows[1]);
    EXPECT_EQ(179 + 177, rows[2]);
}

TEST(LoadFabric, StrandsAreHeldByTheirEnds)
{
    const std::string strand = "strand: {material: wool, from: [0, 3, 0], to: [0, 0, 0], segments: 9, radius: 0.1}";
    EXPECT_EQ((std::vector<int>{0, 1, 8, 9}), pinned("{corners: all, patch: 2}", strand));
    EXPECT_EQ((std::vector<int>{0}), pinned("{edge: y+}", strand));
    EXPECT_EQ((std::vector<int>{9}), pinned("{corners: [y-]}", strand));
}

TEST(LoadFabric, WeaveWithoutBordersIsHeldAtTheEndsOfYarns)
{
    const std::vector<int> held =
        pinned("{corners: all, patch: 2, border_only: true}",
               "woven_yarns: {material: wool, yarns: [6, 6], spacing: 1, radius: 0.1, borders: false}");
    EXPECT_EQ(8u, held.size());
    const std::vector<int> side =
        pinned("{edge: x-}", "woven_yarns: {material: wool, yarns: [6, 6], spacing: 1, radius: 0.1, borders: false}");
    EXPECT_EQ((std::vector<int>{0, 6, 12, 18}), side);
}

TEST(LoadFabric, MotionsFindPinsFabricsAndGroups)
{
    const std::string two = kBegin + "fabrics:\n  - {name: a, group: both, " + kSheet +
                            ", pin: [{name: left, edge: x-}, {name: right, edge: x+}]}\n" +
                            "  - {name: b, group: both, " + kSheet + ", pin: {name: left, edge: x-}}\n";
    const auto moving = [&](const std::string& motion) {
        std::string found;
        for (const FabricPiece& p : load(two + "motion: " + motion + "\n").fabrics) {
            for (const sim::PinGroup& pin : p.pins)
                found += pin.motion.transform(1.0) * Vec3(0, 0, 0) == Vec3(0, 2, 0) ? '1' : '0';
        }
        return found;
    };
    EXPECT_EQ("000", moving("{right: {t: [5, 6], translate: [0, 2, 0]}}"));
    EXPECT_EQ("101", moving("[{pin: left, t: [0, 1], translate: [0, 2, 0]}]"));
    EXPECT_EQ("010", moving("{right: {t: [0, 1], translate: [0, 2, 0]}}"));
    EXPECT_EQ("110", moving("[{group: a, t: [0, 1], translate: [0, 2, 0]}]"));
    EXPECT_EQ("111", moving("{both: [{t: [0, 1], translate: [0, 2, 0]}]}"));
}

TEST(LoadFabric, TwistOfPinsReachesTheEdges)
{
    const FabricPiece strand = piece(
        "strand: {material: wool, from: [0, 0, 0], to: [9, 0, 0], segments: 9, radius: 0.1}, "
        "pin: [{edge: x-, patch: 2, twist: true}, {edge: x+, patch: 2}]");
    const sim::Fabric fabric = sim::assembleFabric({&strand, 1});
    for (std::size_t e = 0; e < 9; ++e) EXPECT_EQ(e < 2, fabric.edges.twistHeld[e] != 0) << e;
}

/// A file that is there as long as this object.
struct ObjFile {
    explicit ObjFile(const std::string& text)
        : path(std::filesystem::temp_directory_path() / ("drench_fabric_" + std::to_string(getpid()) + ".obj"))
    {
        std::ofstream(path) << text;
    }
    ~ObjFile() { std::filesystem::remove(path); }
    ObjFile(const ObjFile&) = delete;
    ObjFile& operator=(const ObjFile&) = delete;
    std::filesystem::path path;
};

TEST(LoadFabric, MeshesAreScaledAndOrientedAlike)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n");
    const FabricPiece mesh = piece("mesh: {material: wool, radius: 0.05, scale: 2, file: " + file.path.string() + "}");
    EXPECT_EQ((std::vector<sim::Vec3i>{{0, 1, 2}, {0, 2, 3}}), mesh.faces);
    EXPECT_EQ(Vec3(2, 2, 0), mesh.points.at(2));
    EXPECT_NEAR(4.0 * 0.1 * 1.32 * 0.4, massOf(mesh), 1.0e-14);
}

TEST(LoadFabric, MeshesHaveTheUnitOfTheirScene)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    const auto sizeOf = [&](const std::string& scale) {
        return load("units: si\ngrid: {cell: 0.01}\nmaterials: {wool: {young: 1.0e+5}}\nfabrics: [{mesh: {material: wool, radius: 1 mm, file: " + file.path.string() + scale + "}}]\n")
            .fabrics.at(0).points.at(1)[0];
    };
    EXPECT_DOUBLE_EQ(100.0, sizeOf(""));
    EXPECT_DOUBLE_EQ(2.0, sizeOf(", scale: 0.02"));
    EXPECT_DOUBLE_EQ(2.0, sizeOf(", scale: 2 cm"));
}

TEST(LoadFabric, VerticesAtOnePlaceAreOneUnlessTheSceneSaysOtherwise)
{
    const ObjFile file("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0.0000001\nv 0 1 0\nf 2 3 4\nf 5 6 7\n");
    const std::string begin = "mesh: {material: wool, radius: 0.05, file: " + file.path.string();
    const FabricPiece welded = piece(begin + "}"), apart = piece(begin + ", weld: 0}"), asked = piece(begin + ", weld: 2.0e-7}"), wide = piece(begin + ", weld: 1 mm}");
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

TEST(LoadFabric, PinsNameVerticesOfTheFile)
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
TEST(LoadFabric, MistakesNameVerticesOfTheFile)
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
TEST(LoadFabric, ASoupOfTrianglesIsOneSheet)
{
    for (const double size : {1.0e-2, 1.0, 300.0}) {
        constexpr int kCells = 5;
        std::string text, faces;
        int corners = 0;
        for (int n = 0; n < 2 * kCells * kCells; ++n) {
            const int cell = (n * 7) % (2 * kCells * kCells), i = cell / 2 % kCells, j = cell / 2 / kCells;
            const std::array<std::array<int, 2>, 3> ends = cell % 2 ? std::array<std::array<int, 2>, 3>{{{i, j}, {i + 1, j}, {i + 1, j + 1}}}
                                                                    : std::array<std::array<int, 2>, 3>{{{i + 1, j + 1}, {i, j + 1}, {i, j}}};
            for (const auto& [a, b] : ends) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", static_cast<float>(size * 0.3 * a), 0.0, static_cast<float>(size * 0.3 * b));
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

TEST(LoadFabric, LinesOfAFileAreYarns)
{
    const ObjFile file("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 1 1 0\nl 1 2 3\nl 2 -1\n");
    const FabricPiece net = piece("points: {material: wool, radius: 0.05, file: " + file.path.string() + "}");
    EXPECT_TRUE(net.notes.empty());
    EXPECT_EQ((std::vector<std::vector<int>>{{0, 1, 2}, {1, 3}}), net.strands);
    EXPECT_NEAR(3.0 * sim::kPi * 0.05 * 0.05 * 1.32 * 0.4, massOf(net), 1.0e-15);
}

TEST(LoadFabric, PointsOfNoLineAreLeftOut)
{
    const ObjFile file("v 9 0 0\nv 0 0 0\nv 1 0 0\nv 9 9 0\nv 2 0 0\nv 2 0 0\nl 2 3 5\n");
    const FabricPiece yarn = piece("points: {material: wool, radius: 0.05, file: " + file.path.string() + "}, pin: {nodes: [2, 4]}");
    EXPECT_EQ((std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), yarn.points);
    EXPECT_EQ((std::vector<int>{1, 2}), yarn.pins.at(0).vertices);
    ASSERT_EQ(1u, yarn.notes.size());
    EXPECT_NE(std::string::npos, yarn.notes[0].find("3 of its vertices are in no line")) << yarn.notes[0];
}

TEST(LoadFabric, OverridesReachIntoPiecesAndMaterials)
{
    const Scene scene =
        load(kBegin + "fabrics: [{name: it, " + kSheet + ", pin: {corners: all}}]\n",
             {"fabrics.it.cloth_grid.nodes=[7, 7]", "materials.wool.young=5", "fabrics.it.pin.patch=2"});
    EXPECT_EQ(49u, scene.fabrics.at(0).points.size());
    EXPECT_EQ(5.0, scene.fabrics[0].material.young);
    EXPECT_EQ(16u, scene.fabrics[0].pins.at(0).vertices.size());
}

TEST(LoadFabric, UnitsAreConverted)
{
    const Scene scene = load(R"(
units: si
grid: {cell: 0.01}
materials: {wool: {young: 1.0e+5}}
fabrics: [{cloth_grid: {material: wool, nodes: [3, 3], spacing: 0.01, radius: 0.2 mm}, velocity: [1, 0, 0]}]
)");
    EXPECT_DOUBLE_EQ(1.0e6, scene.fabrics.at(0).material.young);
    EXPECT_TRUE(Vec3(2, 0, 2).isApprox(scene.fabrics[0].points.back()));
    EXPECT_DOUBLE_EQ(0.02, scene.fabrics[0].radius[0]);
    EXPECT_EQ(Vec3(100, 0, 0), scene.fabrics[0].velocity);
}

}  // namespace
