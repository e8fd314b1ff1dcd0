// How finely fabric is meshed, and how large cells are, does not decide how much fabric drinks nor how hard it is to flow through.
#include "sim/coupling/porous_law.h"
#include "sim/fabric/pieces/generators.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

Scene sceneOf(FabricSolver solver, double cell, double dt)
{
    Scene scene;
    scene.name = "mesh";
    scene.settings.cell = cell;
    scene.settings.gravity.setZero();
    scene.settings.fabric.solver = solver;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = dt;
    scene.settings.porous.fibreDiameter = 0.01;
    return scene;
}

SourceSettings source(const Shape& shape, const Vec3& velocity = Vec3::Zero())
{
    SourceSettings settings;
    settings.name = "liquid";
    settings.shape = shape;
    Emission emission;
    emission.velocity = velocity;
    settings.emissions.push_back(emission);
    return settings;
}

FabricPiece piece(const FabricGeometry& geometry, const std::array<double, 2>& radius)
{
    FabricPiece piece = testing::pieceOf(geometry, testing::wool(), radius);
    piece.material.volumeFraction = 0.4;
    piece.material.young = 6.6e6;
    return piece;
}

/// A drop at 100 cm/s has met a free square of 3 cm for 20 ms, or a row of yarns as long. @return what it has lost to it [g]
double uptake(FabricSolver solver, int nodes, double cell, bool isYarns)
{
    Scene scene = sceneOf(solver, cell, 5.0e-4);
    scene.sources.push_back(source(Shape::ball(Vec3(0.0, 1.2, 0.0), 1.0), Vec3(0.0, -100.0, 0.0)));
    const double spacing = 3.0 / (nodes - 1);
    const FabricGeometry square = clothGrid({{nodes, nodes}, {spacing, spacing}, Vec3(-1.5, 0.0, -1.5), Vec3::UnitX(), Vec3::UnitZ()});
    if (!isYarns) scene.fabrics.push_back(piece(square, {0.0165, 0.018}));
    for (int n = 0; n < 15 && isYarns; ++n) {
        const double x = 0.2 * (n - 7);
        scene.fabrics.push_back(piece(strand(Vec3(x, 0.0, -1.5), Vec3(x, 0.0, 1.5), nodes - 1), {0.05, 0.05}));
    }
    Simulation simulation(scene);
    double absorbed = 0.0;
    while (simulation.state().time < 0.02 - 1.0e-9) absorbed = simulation.step(0.02).absorbedMass;
    return absorbed;
}

class MeshIndependence : public ::testing::TestWithParam<FabricSolver> {};

TEST_P(MeshIndependence, UptakeOfCloth)
{
    const double usual = uptake(GetParam(), 25, 0.25, false);
    EXPECT_GT(usual, 0.02);
    for (int nodes : {13, 49}) EXPECT_NEAR(uptake(GetParam(), nodes, 0.25, false), usual, 0.1 * usual) << nodes;
    for (double cell : {0.35, 0.175, 0.125}) EXPECT_NEAR(uptake(GetParam(), 25, cell, false), usual, 0.1 * usual) << cell;
}

TEST_P(MeshIndependence, UptakeOfYarns)
{
    const double usual = uptake(GetParam(), 25, 0.25, true);
    EXPECT_GT(usual, 0.02);
    for (int nodes : {13, 49}) EXPECT_NEAR(uptake(GetParam(), nodes, 0.25, true), usual, 0.1 * usual) << nodes;
    for (double cell : {0.35, 0.175, 0.125}) EXPECT_NEAR(uptake(GetParam(), 25, cell, true), usual, 0.1 * usual) << cell;
}

TEST(MeshIndependenceOf, BothSolvers)
{
    const double vertex = uptake(FabricSolver::Vertex, 25, 0.25, false);
    EXPECT_NEAR(uptake(FabricSolver::Grid, 25, 0.25, false), vertex, 0.1 * vertex);
}

/// A slug of 5 cm at 5 cm/s in a duct of 1 cm² with a sheet held across it: the rate at which its momentum decays [1/s].
double slugDecay(FabricSolver solver, int nodes, double cell, double height)
{
    Scene scene = sceneOf(solver, cell, 1.0e-3);
    scene.settings.porous.fibreDiameter = 0.05;
    scene.settings.fabric.contact = false;
    scene.settings.coupling.drag = DragLaw::Linear;
    scene.settings.coupling.capillary = scene.settings.coupling.drip = false;
    scene.settings.coupling.capture.rate = 0.0;
    scene.obstacles.push_back(obstacle("duct", Shape::box(Vec3(0.5, 0.0, 0.5), Vec3(0.5, 20.0, 0.5)).inverted()));
    scene.sources.push_back(source(Shape::box(Vec3(0.5, 0.0, 0.5), Vec3(0.5, 2.5, 0.5)), Vec3(0.0, -5.0, 0.0)));
    const double spacing = 2.0 / (nodes - 1);
    FabricPiece sheet = piece(clothGrid({{nodes, nodes}, {spacing, spacing}, Vec3(-0.5, height, -0.5), Vec3::UnitX(), Vec3::UnitZ()}), {0.03, 0.03});
    PinGroup all;
    for (int v = 0; v < nodes * nodes; ++v) all.vertices.push_back(v);
    sheet.pins.push_back(all);
    scene.fabrics.push_back(sheet);
    Simulation simulation(scene);
    const auto momentum = [&] {
        const LiquidParticles& p = simulation.state().liquid;
        double sum = 0.0;
        for (std::size_t i = 0; i < p.count; ++i) sum -= p.mass[i] * p.velocity(i).y();
        return sum;
    };
    while (simulation.state().time < 0.01 - 1.0e-9) simulation.step(0.01);
    const double first = momentum();
    while (simulation.state().time < 0.05 - 1.0e-9) simulation.step(0.05);
    return std::log(first / momentum()) / 0.04;
}

/// Darcy's law on the superficial velocity: Δp = μ/k U thickness.
TEST_P(MeshIndependence, ResistanceOfASheet)
{
    const double darcy = LiquidSettings().viscosity / permeability(0.4, 0.05).across * 0.06 / 5.0;
    EXPECT_NEAR(darcy, 2.515, 1.0e-3);
    for (const double cell : {0.25, 0.125})
        for (const double height : {0.02, -0.07, 0.11})
            EXPECT_NEAR(slugDecay(GetParam(), 33, cell, height), darcy, 0.1 * darcy) << cell << ' ' << height;
    if (GetParam() == FabricSolver::Vertex) {  // on faces liquid slips between vertices more than a cell apart
        EXPECT_NEAR(slugDecay(GetParam(), 9, 0.25, 0.02), darcy, 0.1 * darcy);
        EXPECT_NEAR(slugDecay(GetParam(), 9, 0.125, 0.02), darcy, 0.1 * darcy);
    }
}

/// How far a yarn of 0.12 cm has sunk in still water after 0.15 s [cm].
double sunk(FabricSolver solver, int segments, double cell, double angle)
{
    Scene scene = sceneOf(solver, cell, 1.0e-3);
    scene.settings.gravity = Vec3(0.0, -981.0, 0.0);
    scene.settings.coupling.capillary = scene.settings.coupling.drip = false;
    scene.settings.coupling.capture.rate = 0.0;
    scene.obstacles.push_back(obstacle("tank", Shape::box(Vec3(0.0, 2.0, 0.0), Vec3(1.2, 2.0, 0.8)).inverted()));
    scene.sources.push_back(source(Shape::box(Vec3(0.0, 1.2, 0.0), Vec3(1.2, 1.2, 0.8))));
    const Vec3 along(0.6 * std::sin(angle), 0.0, 0.6 * std::cos(angle)), middle(0.0, 1.6, 0.0);
    FabricPiece yarn = piece(strand(middle - along, middle + along, segments), {0.06, 0.06});
    yarn.material.density = 1.64;
    scene.fabrics.push_back(yarn);
    Simulation simulation(scene);
    while (simulation.state().time < 0.15 - 1.0e-9) simulation.step(0.15);
    double sum = 0.0;
    for (const Vec3& x : simulation.state().fabric.x) sum += middle.y() - x.y();
    return sum / static_cast<double>(simulation.state().fabric.x.size());
}

TEST_P(MeshIndependence, SinkingYarn)
{
    const double usual = sunk(GetParam(), 16, 0.2, 0.0);
    EXPECT_GT(usual, 0.4);
    for (double cell : {0.4, 0.1}) EXPECT_NEAR(sunk(GetParam(), 16, cell, 0.0), usual, 0.15 * usual) << cell;
    for (int segments : {8, 32}) EXPECT_NEAR(sunk(GetParam(), segments, 0.2, 0.0), usual, 0.02 * usual) << segments;
    EXPECT_NEAR(sunk(GetParam(), 16, 0.2, 0.7), usual, 0.1 * usual);
}

INSTANTIATE_TEST_SUITE_P(Solvers, MeshIndependence, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& tested) { return tested.param == FabricSolver::Grid ? "grid" : "vertex"; });

}  // namespace
}  // namespace sim::test
