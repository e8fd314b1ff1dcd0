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

const std::string kSheet = "cloth_grid: {material: wool, nodes: [5, 4], spacing: 1, radius: 0.1}";

std::vector<int> pinned(const std::string& pin, const std::string& shape = kSheet) { return piece(shape + ", pin: " + pin).pins.at(0).vertices; }

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
    EXPECT_EQ((std::vector<int>{0, 99, 9700, 9799, 9800, 9899, 19500, 19599, 19600, 19601, 19602, 19603}), cloth.pins.at(0).vertices);
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
    const auto porous = [](const std::string& text) { return load(kBegin + "porous: " + text + "\nfabrics: [{" + kSheet + "}]\n").settings.porous; };
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
    const FabricPiece a = piece("cloth_grid: {material: wool, nodes: [5, 3], spacing: [0.5, 2], radius: 0.1, origin: [-1, 7, -2]}");
    const FabricPiece b = piece("cloth_grid: {material: wool, nodes: [5, 3], size: [2, 4], radius: 0.1, center: [0, 7, 0]}");
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t i = 0; i < a.points.size(); ++i) EXPECT_TRUE(a.points[i].isApprox(b.points[i], 1.0e-14)) << i;
}

TEST(LoadFabric, TransformTurnsAboutTheMiddleThenMoves)
{
    const FabricPiece still = piece(kSheet);
    const FabricPiece moved = piece(kSheet + ", transform: {translate: [10, 0, 0], rotate: {axis: [0, 0, 1], angle: 90}}");
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
    const std::vector<int> rows = pinned("{edge: y+, patch: 2}",
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
    const std::vector<int> held = pinned("{corners: all, patch: 2, border_only: true}",
                                         "woven_yarns: {material: wool, yarns: [6, 6], spacing: 1, radius: 0.1, borders: false}");
    EXPECT_EQ(8u, held.size());
    const std::vector<int> side = pinned("{edge: x-}", "woven_yarns: {material: wool, yarns: [6, 6], spacing: 1, radius: 0.1, borders: false}");
    EXPECT_EQ((std::vector<int>{0, 6, 12, 18}), side);
}

TEST(LoadFabric, MotionsFindPinsFabricsAndGroups)
{
    const std::string two = kBegin + "fabrics:\n  - {name: a, group: both, " + kSheet +
                            ", pin: [{name: left, edge: x-}, {name: right, edge: x+}]}\n" + "  - {name: b, group: both, " + kSheet +
                            ", pin: {name: left, edge: x-}}\n";
    const auto moving = [&](const std::string& motion) {
        std::string found;
        for (const FabricPiece& p : load(two + "motion: " + motion + "\n").fabrics) {
            for (const sim::PinGroup& pin : p.pins) found += pin.motion.transform(1.0) * Vec3(0, 0, 0) == Vec3(0, 2, 0) ? '1' : '0';
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

TEST(LoadFabric, OverridesReachIntoPiecesAndMaterials)
{
    const Scene scene = load(kBegin + "fabrics: [{name: it, " + kSheet + ", pin: {corners: all}}]\n",
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
