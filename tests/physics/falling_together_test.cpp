// Gravity acts on liquid and on fabric over one and the same interval, however steps change their length.
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A drop and beside it, near enough for its grid, a wet sheet, both free: nothing but gravity acts.
Scene dropBesideSheet(FabricSolver solver, TimeIntegrator integrator)
{
    Scene scene;
    scene.name = "fall";
    scene.settings.cell = 0.25;
    scene.settings.fabric.solver = solver;
    scene.settings.time.integrator = integrator;
    scene.settings.coupling.capture.rate = 0.0;
    scene.settings.coupling.capillary = false;
    scene.settings.liquid.volume.rate = 0.0;
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball(Vec3(0.0, 0.9, 0.0), 0.6);
    drop.emissions.push_back({});
    scene.sources.push_back(drop);
    FabricPiece sheet = testing::pieceOf(clothGrid({{9, 9}, {0.2, 0.2}, Vec3(-0.8, 0.0, -0.8)}), testing::wool(), {0.03, 0.03});
    sheet.wetness = 0.7;
    scene.fabrics.push_back(sheet);
    return scene;
}

class FallingTogether : public ::testing::TestWithParam<std::tuple<FabricSolver, TimeIntegrator>> {};

TEST_P(FallingTogether, BothPhasesKeepOneVelocityWhenStepsChange)
{
    const auto [solver, integrator] = GetParam();
    Simulation simulation(dropBesideSheet(solver, integrator));
    const std::vector<double> wet = simulation.state().fabric.absorbed;
    double fallen = 0.0;
    for (const double dt : {1.0e-3, 1.0e-3, 2.5e-4, 5.0e-4, 2.0e-3, 1.9e-3, 3.0e-4, 3.0e-4, 1.2e-3}) {
        const double end = simulation.state().time + dt;
        while (simulation.state().time < end) {
            const double before = simulation.state().lastDt;
            const StepReport report = simulation.step(end);
            const bool isHalf = integrator == TimeIntegrator::Reflected && before == 0.0;  // velocities of halfway through steps
            fallen += kEarthGravity * (isHalf ? 0.5 : 1.0) * report.dt;
        }
        const Vec3 expected(0.0, -fallen, 0.0);
        const State& state = simulation.state();
        for (std::size_t p = 0; p < state.liquid.count; ++p) ASSERT_LT((state.liquid.velocity(p) - expected).norm(), 1.0e-10 * fallen);
        for (const Vec3& v : state.fabric.v) ASSERT_LT((v - expected).norm(), 1.0e-10 * fallen);
    }
    // What falls freely with its water drives none of it.
    for (std::size_t v = 0; v < wet.size(); ++v) EXPECT_NEAR(simulation.state().fabric.absorbed[v], wet[v], 1.0e-9 * wet[v]);
}

INSTANTIATE_TEST_SUITE_P(Solvers, FallingTogether,
                         ::testing::Combine(::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                                            ::testing::Values(TimeIntegrator::Plain, TimeIntegrator::Reflected)),
                         [](const auto& given) {
                             return std::string(std::get<0>(given.param) == FabricSolver::Grid ? "grid" : "vertex") +
                                    (std::get<1>(given.param) == TimeIntegrator::Plain ? "Plain" : "Reflected");
                         });

/// Wet cloth that hangs still bears its weight over a step however short: gravity for half of a long one would kick it.
TEST(HangingStill, WetClothIsNotKickedByAShortStep)
{
    for (const bool hasPool : {false, true}) {
        Scene scene = dropBesideSheet(FabricSolver::Vertex, TimeIntegrator::Reflected);
        PinGroup edges;
        for (int v = 0; v < 81; ++v)
            if (v % 9 == 0 || v % 9 == 8) edges.vertices.push_back(v);
        scene.fabrics[0].pins.push_back(edges);
        scene.fabrics[0].material.dampingViscosity = 1.0e3;
        scene.sources[0].shape = Shape::box(Vec3(0.0, -1.0, 0.0), Vec3(1.0, 0.5, 1.0));
        if (!hasPool) scene.sources.clear();
        ObstacleSettings tank;
        tank.name = "tank";
        tank.shape = Shape::box(Vec3(0.0, 1.0, 0.0), Vec3(1.0, 2.5, 1.0)).inverted();
        scene.obstacles.push_back(tank);
        scene.settings.time.dt = 2.0e-3;
        Simulation simulation(scene);
        for (int n = 1; n <= 60; ++n) simulation.step(n * 2.0e-3);
        const auto speed = [&] {
            double fastest = 0.0;
            for (const Vec3& v : simulation.state().fabric.v) fastest = std::max(fastest, v.norm());
            return fastest;
        };
        const double before = speed();
        simulation.step(simulation.state().time + 1.0e-4);
        EXPECT_LT(speed(), before + 0.1 * kEarthGravity * 1.0e-3) << "half of the step before would have been a speed of 1 cm/s";
    }
}

/// And the budget of energy knows of it.
TEST(FallingTogether, EnergyOfTheFallIsBooked)
{
    Simulation simulation(dropBesideSheet(FabricSolver::Vertex, TimeIntegrator::Reflected));
    simulation.bookEnergy();
    for (const double dt : {1.0e-3, 2.5e-4, 2.0e-3, 3.0e-4}) {
        const double end = simulation.state().time + dt;
        while (simulation.state().time < end) {
            const double energy = simulation.energies().total();
            const StepReport report = simulation.step(end);
            double booked = 0.0;
            for (double change : report.energyChanges->of) booked += change;
            EXPECT_NEAR(simulation.energies().total() - energy, booked, 1.0e-9 * report.energies.fabric.kinetic + 1.0e-12);
        }
    }
}

}  // namespace
}  // namespace sim::test
