// Forces on fabric: pins, liquid and contact.
#include "tests/physics/closed_step.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

FabricPiece sheet(const Vec3& origin, int nodes, double spacing)
{
    FabricPiece piece = testing::pieceOf(clothGrid({{nodes, nodes}, {spacing, spacing}, origin}), testing::wool(), {0.03, 0.03});
    piece.material.frictionAngle = 0.5;
    return piece;
}

PinGroup pinsAt(std::vector<int> vertices)
{
    PinGroup pins;
    pins.vertices = std::move(vertices);
    return pins;
}

class ForcesOf : public ::testing::TestWithParam<FabricSolver> {
 protected:
    Scene scene() const
    {
        Scene scene;
        scene.name = "forces";
        scene.settings.cell = 0.25;
        scene.settings.fabric.solver = GetParam();
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 1.0e-3;
        scene.settings.porous.fibreDiameter = 0.01;
        return scene;
    }
};

/// A towel that hangs from two groups of pins.
TEST_P(ForcesOf, PinsCarryAWetTowel)
{
    Scene wet = scene();
    FabricPiece towel =
        testing::pieceOf(clothGrid({{13, 13}, {0.25, 0.25}, Vec3(0.0, 5.0, 0.0), Vec3::UnitX(), -Vec3::UnitY()}), testing::wool(), {0.05, 0.05});
    towel.material.dampingViscosity = 2000.0;
    towel.wetness = 0.7;
    towel.pins = {pinsAt({0, 1, 2, 3}), pinsAt({9, 10, 11, 12})};
    wet.fabrics = {towel};
    wet.settings.time.dt = 2.0e-3;
    Simulation simulation(wet);
    Vec3 mean[2] = {Vec3::Zero(), Vec3::Zero()};
    constexpr int kSteps = 600, kFrom = 400;
    for (int step = 0; step < kSteps; ++step) {
        const ClosedStep closed(simulation);
        ASSERT_LT(closed.error, kExact * closed.exchanged);
        for (int group = 0; group < 2 && step >= kFrom; ++group) mean[group] += simulation.forces().pins[group].linear / simulation.forces().dt;
    }
    double mass = 0.0;
    for (std::size_t v = 0; v < simulation.fabric().vertexCount(); ++v) mass += simulation.fabric().mass[v] + simulation.state().fabric.absorbed[v];
    const double weight = mass * kEarthGravity * (kSteps - kFrom);
    EXPECT_LT(((mean[0] + mean[1]) / weight + Vec3::UnitY()).norm(), 1.0e-3);
    EXPECT_NEAR(mean[0].y() / mean[1].y(), 1.0, 0.02);
    EXPECT_GT(mean[0].x(), 0.0);  // the towel pulls its corners together
    EXPECT_LT(mean[1].x(), 0.0);
}

/// A wet yarn that hangs straight from one pin, and one that sags between two. What stretches them swings, a hundredth as large every 1.4 s at the
/// slowest: that is what is left.
TEST_P(ForcesOf, PinsCarryWetYarnsAtRest)
{
    for (const bool sags : {false, true}) {
        Scene wet = scene();
        const Vec3 end = sags ? Vec3(1.5, 5.0, 0.0) : Vec3(0.0, 3.5, 0.0);
        FabricPiece yarn = testing::pieceOf(strand(Vec3(0.0, 5.0, 0.0), end, 10), testing::wool(), {0.05, 0.05});
        yarn.material.young = 1.0e6;
        yarn.material.dampingViscosity = 1.0e5;
        yarn.wetness = 0.7;
        yarn.pins = {pinsAt(sags ? std::vector{0, 10} : std::vector{0})};
        wet.fabrics = {yarn};
        wet.settings.fabric.tolerance = 1.0e-12;
        Simulation simulation(wet);
        for (int step = 0; step < 3500; ++step) simulation.step(1.0e9);
        const std::vector<double>& absorbed = simulation.state().fabric.absorbed;
        const double water = std::accumulate(absorbed.begin(), absorbed.end(), 0.0),
                     dry = std::accumulate(simulation.fabric().mass.begin(), simulation.fabric().mass.end(), 0.0);
        EXPECT_GT(water, 0.5 * dry);
        const Vec3 pull = simulation.forces().pins[0].linear / simulation.forces().dt;
        EXPECT_LT((pull / ((dry + water) * kEarthGravity) + Vec3::UnitY()).norm(), 1.0e-8) << (sags ? "between two pins" : "from one");
    }
}

/// A slug of water flies against a sheet that pins hold.
TEST_P(ForcesOf, ASheetInASlugDragsItByWhatItLoses)
{
    Scene slug = scene();
    slug.settings.gravity.setZero();
    FabricPiece cloth = sheet(Vec3(-1.0, 0.0, -1.0), 17, 0.125);
    std::vector<int> border;
    for (int v = 0; v < 17 * 17; ++v)
        if (v % 17 == 0 || v % 17 == 16 || v / 17 == 0 || v / 17 == 16) border.push_back(v);
    cloth.pins = {pinsAt(border)};
    slug.fabrics = {cloth};
    SourceSettings water;
    water.shape = Shape::ball(Vec3(0.0, 0.9, 0.0), 0.7);
    Emission emission;
    emission.velocity = Vec3(20.0, -80.0, 0.0);
    water.emissions.push_back(emission);
    slug.sources.push_back(water);
    Simulation simulation(slug);
    double largest = 0.0;
    for (int step = 0; step < 30; ++step) {
        const Vec3 before = momentumOfLiquid(simulation), fabricBefore = momentumOfFabric(simulation);
        const ClosedStep closed(simulation);
        EXPECT_LT(closed.error, kExact * closed.exchanged + 1.0e-13 * before.norm());
        const Forces& forces = simulation.forces();
        const Vec3 lost = before - momentumOfLiquid(simulation), got = forces.fabrics[0].liquid.linear;
        EXPECT_LT((lost - got).norm(), kExact * std::max(got.norm(), 1.0)) << step << ": " << lost.transpose() << " | " << got.transpose();
        EXPECT_LT((momentumOfFabric(simulation) - fabricBefore - got + forces.pins[0].linear).norm(), kExact * std::max(got.norm(), 1.0));
        largest = std::max(largest, got.norm());
    }
    EXPECT_GT(largest, 1.0);
}

/// Fabric that is not solved for holds liquid up all the same: what that loses is the fabric's, and no solid has to bear it.
TEST(Forces, CloseAroundFabricThatIsNotSolvedFor)
{
    for (const bool hasPins : {false, true})
        for (const double cell : {0.5, 0.3}) {
            Scene scene = tankScene(kPoly8, cell, {5.0 / cell, 7.0 / cell, 5.0 / cell}, {0.5 / cell, 2.6 / cell, 0.5 / cell},
                                    {4.5 / cell, 4.5 / cell, 4.5 / cell});
            scene.settings.fabric.solver = FabricSolver::Off;
            scene.settings.time.mode = TimeMode::Fixed;
            scene.settings.time.dt = 1.0e-3;
            scene.settings.porous.fibreDiameter = 0.01;
            scene.fabrics = {sheet(Vec3(1.0, 2.5, 1.0), 13, 0.25)};
            if (hasPins) scene.fabrics[0].pins = {pinsAt({0, 1, 12})};
            Motion motion;
            motion.addOscillation(0.0, 100.0, Vec3(0.3, 1.0, 0.2).normalized(), 0.1, 20.0);
            scene.obstacles.push_back(obstacle("ball", Shape::ball({2.5, 3.5, 2.5}, 0.6), motion));
            Simulation simulation(scene);
            double onFabric = 0.0;
            for (int step = 0; step < 40; ++step) {
                const ClosedStep closed(simulation);
                EXPECT_LT(closed.error, kExact * closed.exchanged);
                EXPECT_LT(simulation.forces().balance.borne.norm(), 6.0e-3 * closed.exchanged) << step;
                onFabric = std::max(onFabric, simulation.forces().fabrics[0].liquid.linear.norm() / closed.exchanged);
            }
            EXPECT_GT(onFabric, 0.05);
        }
}

/// A sheet falls on a ball, another one on it.
TEST_P(ForcesOf, ContactPushesBothSides)
{
    Scene pile = scene();
    pile.fabrics = {sheet(Vec3(-0.8, 0.1, -0.8), 9, 0.2), sheet(Vec3(-0.6, 0.18, -0.6), 7, 0.2)};
    pile.obstacles.push_back(obstacle("ball", Shape::ball(Vec3(0.0, -1.0, 0.0), 1.0)));
    Simulation simulation(pile);
    Vec3 onBall = Vec3::Zero(), onTop = Vec3::Zero();
    double weight = 0.0, above = 0.0;
    constexpr int kSteps = 300, kFrom = 100;
    for (int step = 0; step < kSteps; ++step) {
        const ClosedStep closed(simulation);
        ASSERT_LT(closed.error, kExact * closed.exchanged);
        const Forces& forces = simulation.forces();
        EXPECT_LT((forces.obstacles[0].contact + forces.fabrics[0].contact + forces.fabrics[1].contact).linear.norm(), kExact * closed.exchanged);
        EXPECT_LT((forces.obstacles[0].contact + forces.fabrics[0].contact + forces.fabrics[1].contact).angular.norm(),
                  10.0 * kExact * closed.exchanged);
        if (step < kFrom) continue;
        onBall += forces.obstacles[0].contact.linear;
        onTop += forces.fabrics[1].contact.linear;
        weight += forces.balance.weight.norm();
    }
    for (std::size_t v = 0; v < simulation.fabric().vertexCount(); ++v)
        if (simulation.fabric().pieceOf(static_cast<int>(v)) == 1) above += simulation.fabric().mass[v];
    EXPECT_LT((onBall + weight * Vec3::UnitY()).norm(), 0.01 * weight);
    EXPECT_LT((onTop / (above * kEarthGravity * (kSteps - kFrom) * pile.settings.time.dt) - Vec3::UnitY()).norm(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Solvers, ForcesOf, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& tested) { return tested.param == FabricSolver::Grid ? "grid" : "vertex"; });

}  // namespace
}  // namespace sim::test
