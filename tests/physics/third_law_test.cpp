// Action and reaction: what liquid and fabric that nothing holds do to each other changes nothing of the momentum that they have together.
#include "tests/physics/fabric_runs.h"
#include "tests/physics/random_vector.h"

#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A drop that meets a sheet with a yarn across it and a sheet of its own further off, all turned and thrown as chance has it.
Scene wetFabric(FabricSolver solver, Random& random)
{
    Scene scene;
    scene.name = "wet fabric";
    scene.settings.cell = 0.25;
    scene.settings.gravity.setZero();
    scene.settings.fabric.solver = solver;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = between(5.0e-4, 1.5e-3, random);
    scene.settings.porous.fibreDiameter = 0.01;
    scene.settings.liquid.surfaceTensionForce = true;
    scene.settings.liquid.solveViscosity = between(0.0, 1.0, random) < 0.3;

    const FabricGeometry square = clothGrid({{11, 11}, {0.2, 0.2}, Vec3(-1.0, 0.0, -1.0)});
    FabricPiece sheet = testing::pieceOf(square, testing::wool(), {0.03, 0.03});
    FabricPiece yarn = testing::pieceOf(strand(Vec3(-0.9, -0.08, 0.1), Vec3(0.9, -0.08, -0.1), 14), testing::wool(), {0.04, 0.03});
    FabricPiece other = testing::pieceOf(clothGrid({{7, 7}, {0.2, 0.2}, Vec3(-0.6, -3.5, -0.6)}), testing::wool(), {0.03, 0.03});
    yarn.velocity = Vec3(0.0, 30.0, 0.0);
    other.velocity = anywhere(20.0, random);
    for (FabricPiece* piece : {&sheet, &yarn, &other}) piece->material.frictionAngle = 0.5;
    scene.fabrics = {sheet, yarn, other};
    SourceSettings drop;
    drop.shape = Shape::ball(Vec3(between(-0.4, 0.4, random), between(0.8, 1.0, random), between(-0.4, 0.4, random)), 0.7);
    Emission emission;
    emission.velocity = Vec3(0.0, -80.0, 0.0) + anywhere(30.0, random);
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
    return scene;
}

Vec3 momentumOf(const Simulation& simulation, bool ofLiquid)
{
    Vec3 sum = Vec3::Zero();
    const LiquidParticles& particles = simulation.state().liquid;
    const FabricState& fabric = simulation.state().fabric;
    for (std::size_t p = 0; p < particles.count && ofLiquid; ++p) sum += particles.mass[p] * particles.velocity(p);
    for (std::size_t v = 0; v < fabric.v.size() && !ofLiquid; ++v) sum += (simulation.fabric().mass[v] + fabric.absorbed[v]) * fabric.v[v];
    return sum;
}

class ThirdLaw : public ::testing::TestWithParam<FabricSolver> {};

TEST_P(ThirdLaw, LiquidAndFreeFabricKeepTheirMomentum)
{
    Random random(7);
    for (int n = 0; n < 4; ++n) {
        SCOPED_TRACE("state " + std::to_string(n));
        const Scene scene = wetFabric(GetParam(), random);
        Simulation simulation(scene);
        const Vec3 liquid = momentumOf(simulation, true), start = liquid + momentumOf(simulation, false);
        double worst = 0.0, absorbed = 0.0;
        for (int step = 0; step < 25; ++step) {
            absorbed = simulation.step(1.0e9).absorbedMass;
            worst = std::max(worst, (momentumOf(simulation, true) + momentumOf(simulation, false) - start).norm());
        }
        const double exchanged = (momentumOf(simulation, true) - liquid).norm();
        EXPECT_GT(absorbed, 0.0);
        EXPECT_GT(exchanged, 0.05 * liquid.norm());
        // What the iterations for viscosity leave of its balance; all else is exact.
        EXPECT_LT(worst, (scene.settings.liquid.solveViscosity ? 1.0e-5 : 1.0e-10) * exchanged);
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, ThirdLaw, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& tested) { return tested.param == FabricSolver::Grid ? "grid" : "vertex"; });

}  // namespace
}  // namespace sim::test
