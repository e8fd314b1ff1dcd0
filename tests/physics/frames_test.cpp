// What happens does not depend on where the scene stands in the grid, how it is turned, seen in a mirror, or in which units it is written.
#include "sim/fabric/pieces/generators.h"
#include "sim/scene/load_scene.h"
#include "sim/scene/scene_file.h"
#include "sim/state_hash.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace sim::test {
namespace {

/// Places in another frame: turned or mirrored about the origin, then shifted.
struct Frame {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();

    Vec3 at(const Vec3& x) const { return turn * x + shift; }
};

/// A drop that falls aslant on a sheet and a yarn above a floor; fabric and liquid meet at once.
Scene wetScene(FabricSolver solver, const Frame& frame, bool hasFloor)
{
    Scene scene;
    scene.name = "frame";
    scene.settings.cell = 0.25;
    scene.settings.gravity = frame.turn * Vec3(0.0, -981.0, 0.0);
    scene.settings.fabric.solver = solver;
    scene.settings.fabric.tolerance = 1.0e-10;
    scene.settings.solver.pressureTolerance = 1.0e-14;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 5.0e-4;
    scene.settings.porous.fibreDiameter = 0.01;
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball(frame.at(Vec3(0.1, 0.7, -0.05)), 0.62);
    drop.fill.spacing = 0.5;
    Emission emission;
    emission.velocity = frame.turn * Vec3(20.0, -80.0, 10.0);
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
    FabricPiece sheet = testing::pieceOf(clothGrid({{9, 11}, {0.2, 0.17}, Vec3(-0.8, 0.02, -0.85)}), testing::wool(), {0.03, 0.03});
    FabricPiece yarn = testing::pieceOf(strand(Vec3(-0.9, 0.25, 0.3), Vec3(0.7, 0.22, 0.4), 12), testing::wool(), {0.04, 0.04});
    for (FabricPiece* piece : {&sheet, &yarn}) {
        for (Vec3& x : piece->points) x = frame.at(x);
        piece->material.volumeFraction = 0.4;
        scene.fabrics.push_back(*piece);
    }
    if (hasFloor) {
        const Vec3 half(9.0, 1.0, 9.0), turned = (frame.turn * half).cwiseAbs();
        scene.obstacles.push_back(obstacle("floor", Shape::box(frame.at(Vec3(0.0, -1.5, 0.0)), turned)));
    }
    return scene;
}

/// What is compared, as seen from the scene's own frame.
struct Seen {
    Vec3 centre, momentum;       ///< of the liquid [cm, g cm/s]
    double kinetic, absorbed;    ///< of the liquid [erg], of the fabric [g]
    std::vector<Vec3> vertices;  ///< [cm]
};

Seen runIn(FabricSolver solver, const Frame& frame, double until, bool hasFloor = true)
{
    Simulation simulation(wetScene(solver, frame, hasFloor));
    StepReport report;
    while (simulation.state().time < until - 1.0e-9) report = simulation.step(until);
    const LiquidParticles& p = simulation.state().liquid;
    Seen seen{Vec3::Zero(), Vec3::Zero(), report.energies.kinetic, report.absorbedMass, {}};
    double mass = 0.0;
    for (std::size_t i = 0; i < p.count; ++i) {
        mass += p.mass[i];
        seen.centre += p.mass[i] * p.position(i);
        seen.momentum += p.mass[i] * p.velocity(i);
    }
    seen.centre = frame.turn.transpose() * (seen.centre / mass - frame.shift);
    seen.momentum = frame.turn.transpose() * seen.momentum;
    for (const Vec3& x : simulation.state().fabric.x) seen.vertices.push_back(frame.turn.transpose() * (x - frame.shift));
    return seen;
}

double farthest(const Seen& a, const Seen& b)
{
    double far = 0.0;
    for (std::size_t v = 0; v < a.vertices.size(); ++v) far = std::max(far, (a.vertices[v] - b.vertices[v]).norm());
    return far;
}

Mat3 turned(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

class Frames : public ::testing::TestWithParam<FabricSolver> {};

/// The grid maps to itself: only rounding may tell.
TEST_P(Frames, LatticeSymmetriesAreExact)
{
    const double until = 5.0e-3, cell = 0.25;
    const Seen here = runIn(GetParam(), {}, until);
    EXPECT_GT(here.absorbed, 1.0e-4);
    const Mat3 quarter = turned(0.5 * kPi, Vec3::UnitY()).array().round(), tipped = turned(0.5 * kPi, Vec3::UnitX()).array().round();
    const Mat3 mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal(), upside = Vec3(1.0, -1.0, -1.0).asDiagonal();
    const Frame frames[] = {{Mat3::Identity(), cell * Vec3(3, -2, 5)},
                            {Mat3::Identity(), cell * Vec3(-64, 8, 1)},
                            {quarter, Vec3::Zero()},
                            {tipped, Vec3::Zero()},
                            {mirror, Vec3::Zero()},
                            {upside, Vec3::Zero()},
                            {tipped * quarter * mirror, cell * Vec3(1, 2, 3)}};
    for (const Frame& frame : frames) {
        SCOPED_TRACE(::testing::PrintToString(frame.turn) + ::testing::PrintToString(frame.shift.transpose()));
        const Seen there = runIn(GetParam(), frame, until);
        EXPECT_LT((there.centre - here.centre).norm(), 1.0e-10);
        EXPECT_LT((there.momentum - here.momentum).norm(), 1.0e-10 * here.momentum.norm());
        EXPECT_NEAR(there.kinetic, here.kinetic, 1.0e-10 * here.kinetic);
        EXPECT_NEAR(there.absorbed, here.absorbed, 1.0e-10 * here.absorbed);
        EXPECT_LT(farthest(there, here), 1.0e-10);
    }
}

/// The grid does not map to itself: its errors tell, but they are small.
TEST_P(Frames, RotationInvarianceIsApproximate)
{
    const double until = 0.015;
    const Seen here = runIn(GetParam(), {}, until, false);
    const Frame frames[] = {{Mat3::Identity(), Vec3(0.08, 0.13, 0.04)},
                            {turned(0.25 * kPi, Vec3::UnitY()), Vec3::Zero()},
                            {turned(0.25 * kPi, Vec3::UnitX()), Vec3(0.1, 0.0, 0.05)},
                            {turned(0.6, Vec3(1.0, 2.0, -1.0)), Vec3::Zero()}};
    const double fallen = 100.0 * until;  // cm
    for (const Frame& frame : frames) {
        SCOPED_TRACE(::testing::PrintToString(frame.turn) + ::testing::PrintToString(frame.shift.transpose()));
        const Seen there = runIn(GetParam(), frame, until, false);
        EXPECT_LT((there.centre - here.centre).norm(), 0.02 * fallen);
        EXPECT_LT((there.momentum - here.momentum).norm(), 0.02 * here.momentum.norm());
        EXPECT_NEAR(there.kinetic, here.kinetic, 0.04 * here.kinetic);
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, Frames, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& tested) { return tested.param == FabricSolver::Grid ? "grid" : "vertex"; });

/// The same scene in centimetres and in metres, number by number: the same bits after some steps.
TEST(Units, CgsAndSiAreTheSameRun)
{
    const std::string cgs = R"(drench: 1
time: {dt: 7.0e-4, duration: 0.01}
grid: {cell: 0.23}
gravity: [3.3, -981, 1.7]
porous: {fibre_diameter: 0.0113, volume_fraction: 0.37}
materials: {wool: {young: 6.6e+6, poisson: 0.35, density: 1.32, damping_viscosity: 1.0e+3, friction_angle: 29}}
liquid:
  {density: 0.97, viscosity: 0.0087, surface_tension: 71.3, surface_tension_force: true,
   sources: [{name: drop, shape: {ball: {center: [0.11, 0.83, -0.07], radius: 0.61}}, velocity: [1.3, -83, 7.1]}]}
obstacles: [{name: floor, shape: {box: {min: [-3.1, -1.9, -2.7], max: [3.3, -0.21, 2.9]}}}]
fabrics:
  - {name: sheet, cloth_grid: {material: wool, nodes: [11, 11], spacing: 0.17, origin: [-0.85, 0.011, -0.85], u: [1, 0, 0], v: [0, 0, 1],
                               radius: 0.0165}}
)",
                      si = R"(drench: 1
units: si
time: {dt: 7.0e-4, duration: 0.01}
grid: {cell: 0.0023}
gravity: [0.033, -9.81, 0.017]
porous: {fibre_diameter: 0.000113, volume_fraction: 0.37}
materials: {wool: {young: 6.6e+5, poisson: 0.35, density: 1320, damping_viscosity: 1.0e+2, friction_angle: 29}}
liquid:
  {density: 970, viscosity: 0.00087, surface_tension: 0.0713, surface_tension_force: true,
   sources: [{name: drop, shape: {ball: {center: [0.0011, 0.0083, -0.0007], radius: 0.0061}}, velocity: [0.013, -0.83, 0.071]}]}
obstacles: [{name: floor, shape: {box: {min: [-0.031, -0.019, -0.027], max: [0.033, -0.0021, 0.029]}}}]
fabrics:
  - {name: sheet, cloth_grid: {material: wool, nodes: [11, 11], spacing: 0.0017, origin: [-0.0085, 0.00011, -0.0085], u: [1, 0, 0], v: [0, 0, 1],
                               radius: 0.000165}}
)";
    const auto hashAfter = [](const std::string& text) {
        Simulation simulation(readScene(sceneFileFromText(text, "units.yaml")));
        for (int n = 0; n < 10; ++n) simulation.step(1.0e9);
        return stateHash(simulation.state());
    };
    EXPECT_EQ(hashAfter(si), hashAfter(cgs));
}

}  // namespace
}  // namespace sim::test
