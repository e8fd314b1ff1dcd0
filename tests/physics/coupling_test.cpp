#include "sim/fabric/pieces/generators.h"
#include "tests/physics/runs.h"
#include "tests/sim/fabric/pieces.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <numeric>

// Liquid and fabric together, whole steps.

namespace sim::test {
namespace {

/// A drop of 1 cm that moves at 100 cm/s, and a free square of cloth in its way. No gravity.
Scene dropAndCloth(DragLaw drag, FabricSolver solver)
{
    Scene scene;
    scene.name = "drop and cloth";
    scene.settings.cell = 0.25;
    scene.settings.gravity.setZero();
    scene.settings.coupling.drag = drag;
    scene.settings.fabric.solver = solver;
    SourceSettings source;
    source.name = "drop";
    source.shape = Shape::ball(Vec3(0.0, 1.2, 0.0), 1.0);
    Emission emission;
    emission.velocity = {0.0, -100.0, 0.0};
    source.emissions.push_back(emission);
    scene.sources.push_back(source);
    FabricPiece cloth = testing::pieceOf(clothGrid({{25, 25}, {0.125, 0.125}, Vec3(-1.5, 0.0, -1.5)}), testing::wool(), {0.0165, 0.018});
    cloth.material.volumeFraction = 0.4;
    scene.fabrics.push_back(cloth);
    return scene;
}

struct Momenta {
    Vec3 liquid = Vec3::Zero(), fabric = Vec3::Zero();
};

Momenta momentaOf(const Simulation& simulation)
{
    Momenta sum;
    const LiquidParticles& particles = simulation.state().liquid;
    for (std::size_t p = 0; p < particles.count; ++p) sum.liquid += particles.mass[p] * particles.velocity(p);
    const FabricState& fabric = simulation.state().fabric;
    for (std::size_t v = 0; v < fabric.v.size(); ++v) sum.fabric += (simulation.fabric().mass[v] + fabric.absorbed[v]) * fabric.v[v];
    return sum;
}

class DropOnCloth : public ::testing::TestWithParam<FabricSolver> {};

TEST_P(DropOnCloth, WhatTheLiquidLosesTheClothGains)
{
    Simulation simulation(dropAndCloth(DragLaw::Nonlinear, GetParam()));
    const Vec3 start = momentaOf(simulation).liquid;
    double worst = 0.0;
    while (simulation.state().time < 0.03 - 1.0e-12) {
        simulation.step(simulation.state().time + 1.0e-3);
        const Momenta now = momentaOf(simulation);
        worst = std::max(worst, (now.liquid + now.fabric - start).norm());
    }
    const Momenta end = momentaOf(simulation);
    EXPECT_GT(end.fabric.y() / start.y(), 0.02);
    EXPECT_LT(worst, 1.0e-10 * end.fabric.norm());
}

/// A drop far from the cloth reflects, one that meets it does not: to reflect a part of its faces would make momentum.
TEST_P(DropOnCloth, IsNotReflectedWhereItMeetsCloth)
{
    Scene scene = dropAndCloth(DragLaw::Nonlinear, GetParam());
    scene.settings.time.integrator = TimeIntegrator::Reflected;
    scene.sources[0].shape = Shape::ball(Vec3(0.0, 5.2, 0.0), 1.0);
    Simulation simulation(scene);
    const Vec3 start = momentaOf(simulation).liquid;
    int reflected = 0, steps = 0;
    for (int frame = 1; frame <= 30; ++frame) {
        const double time = 2.0e-3 * frame;
        StepReport report;
        for (; simulation.state().time < time; ++steps) {
            report = simulation.step(time);
            reflected += report.isReflected ? 1 : 0;
            const Momenta now = momentaOf(simulation);
            EXPECT_LT((now.liquid + now.fabric - start).norm(), 1.0e-10 * start.norm());
        }
        EXPECT_FALSE(report.isReflected);
    }
    EXPECT_GT(momentaOf(simulation).fabric.y() / start.y(), 0.02);
    EXPECT_GT(reflected, 5);
    EXPECT_LT(2 * reflected, steps - 5);
    EXPECT_LT(steps, 80);  // 60 were there none that meet the cloth at once
}

/// Surface tension acts on both phases where the cloth is: left out there, the rest of the surface would pull the drop along, by 3 %. The
/// budget closes with it.
TEST_P(DropOnCloth, SurfaceTensionMakesNoMomentum)
{
    Scene scene = dropAndCloth(DragLaw::Nonlinear, GetParam());
    scene.settings.liquid.surfaceTensionForce = true;
    Simulation simulation(scene);
    simulation.bookEnergy();
    const Vec3 start = momentaOf(simulation).liquid;
    const double energy = simulation.energies().total();
    double booked = 0.0, last = energy;
    for (int n = 1; n <= 30; ++n) {
        const StepReport report = simulation.step(n * 1.0e-3);
        EXPECT_TRUE(report.stageRan[static_cast<int>(Stage::SurfaceTension)]);
        for (double change : report.energyChanges->of) booked += change;
        last = report.energies.total();
        const Ledger& ledger = simulation.state().ledger;
        ASSERT_NEAR(report.liquidMass + report.absorbedMass + ledger.leftMass, ledger.emittedMass, 1.0e-12 * ledger.emittedMass);
    }
    const Momenta end = momentaOf(simulation);
    EXPECT_GT(end.fabric.y() / start.y(), 0.02);
    EXPECT_LT((end.liquid + end.fabric - start).norm(), 1.0e-10 * start.norm());
    std::printf("momentum off by %.2e, energy not booked %.2e\n", (end.liquid + end.fabric - start).norm() / start.norm(),
                (last - energy - booked) / energy);
    EXPECT_NEAR(last - energy, booked, 2.0e-3 * energy);  // two Newton iterations of the cloth
}

/// What surface tension gives where cloth is, it gives by name: the pressure, which follows it, only takes. A drop amid yarns, at rest.
TEST(DropAmidYarns, PressureTakesWhatSurfaceTensionGives)
{
    Scene scene;
    scene.name = "amid yarns";
    scene.settings.cell = 0.1;
    scene.settings.gravity.setZero();
    scene.settings.liquid.surfaceTensionForce = true;
    scene.settings.liquid.surfaceTension = 400.0;
    scene.settings.coupling.capture.rate = 0.0;
    scene.settings.coupling.capillary = false;
    WovenYarns shape;
    shape.yarns = {10, 10};
    shape.spacing = 0.1;
    shape.amplitude = 0.02;
    scene.fabrics = {testing::pieceOf(wovenYarns(shape), testing::wool(), {0.015, 0.015})};
    SourceSettings drop;
    drop.name = "drop";
    drop.emissions.emplace_back();
    drop.shape = Shape::capsule(Vec3(0.45, 0.0, 0.47), Vec3(0.52, 0.02, 0.45), 0.09);
    scene.sources = {drop};
    Simulation simulation(scene);
    simulation.bookEnergy();
    EnergyChanges sum;
    for (int n = 1; n <= 20; ++n) {
        sum += *simulation.step(n * 5.0e-4).energyChanges;
        EXPECT_LT(sum[EnergyChange::Pressure], 0.1 * sum[EnergyChange::SurfaceTension]) << "step " << n;  // the phases slip, which it has no part in
    }
}

/// Free, absorbed and lost liquid are together what was there (coupling/README.md, What is kept), at every step.
void expectLedgerCloses(const Simulation& simulation, const StepReport& report)
{
    const Ledger& ledger = simulation.state().ledger;
    ASSERT_NEAR(report.liquidMass + report.absorbedMass + ledger.leftMass, ledger.emittedMass, 1.0e-12 * ledger.emittedMass)
        << "step " << simulation.state().step;
}

TEST_P(DropOnCloth, WaterIsNeitherMadeNorLost)
{
    Scene scene = dropAndCloth(DragLaw::Nonlinear, GetParam());
    scene.domain = Shape::box(Vec3(0.0, 0.0, 0.0), Vec3(2.0, 1.6, 2.0));
    Simulation simulation(scene);
    double captured = 0.0;
    for (int n = 1; n <= 60; ++n) {
        const StepReport report = simulation.step(n * 1.0e-3);
        captured += report.capturedMass;
        expectLedgerCloses(simulation, report);
    }
    EXPECT_GT(captured, 0.01);
    EXPECT_GT(simulation.state().ledger.leftMass, 0.0);
}

/// A wet towel that hangs drips at its lower hem, in a scene that has no other liquid.
TEST(Towel, DripsWhereItIsLowest)
{
    Scene scene;
    scene.name = "towel";
    scene.settings.cell = 0.15;
    FabricPiece towel = testing::pieceOf(clothGrid({{9, 33}, {0.125, 0.125}, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(0.0, 1.0, 0.0)}),
                                         testing::wool(), {0.05, 0.05});
    towel.wetness = 1.0;
    PinGroup top;
    for (int v = 0; v < 9 * 33; ++v)
        if (towel.points[v].y() > 3.99) top.vertices.push_back(v);
    towel.pins.push_back(top);
    scene.fabrics.push_back(towel);
    Simulation simulation(scene);
    const double wet = simulation.state().ledger.emittedMass;
    EXPECT_GT(wet, 0.0);
    double highest = -1.0e9;
    for (int n = 1; n <= 300; ++n) {
        const std::size_t before = simulation.state().liquid.count;
        const StepReport report = simulation.step(n * 2.0e-3);
        expectLedgerCloses(simulation, report);
        for (std::size_t p = before; p < simulation.state().liquid.count; ++p) highest = std::max(highest, simulation.state().liquid.position(p).y());
    }
    EXPECT_GT(simulation.state().liquid.count, 3u);
    EXPECT_LT(highest, 1.0);
    const std::vector<double>& absorbed = simulation.state().fabric.absorbed;
    EXPECT_LT(absorbed[9 * 32 + 4], 0.9 * absorbed[9 * 1 + 4]);
}

/// Without drag and pressure on it, and dry, the cloth does not feel the liquid.
TEST_P(DropOnCloth, UncoupledClothStandsStill)
{
    Scene scene = dropAndCloth(DragLaw::Off, GetParam());
    scene.settings.coupling.pressureOnFabric = false;
    scene.settings.coupling.capture.rate = 0.0;
    scene.settings.coupling.capillary = false;
    Simulation simulation(scene);
    for (int n = 1; n <= 20; ++n) simulation.step(n * 1.0e-3);
    EXPECT_LT(momentaOf(simulation).fabric.norm(), 1.0e-9 * momentaOf(simulation).liquid.norm());
}

/// The energy book of thirty steps of a millisecond.
struct BookedSteps {
    explicit BookedSteps(Simulation& simulation) : kinetic(simulation.energies().kinetic)
    {
        simulation.bookEnergy();
        const double start = simulation.energies().total();
        double last = start;
        for (int n = 0; n < 30; ++n) {
            const StepReport report = simulation.step(simulation.state().time + 1.0e-3);
            all += *report.energyChanges;
            last = report.energies.total();
        }
        unbooked = last - start - std::accumulate(all.of.begin(), all.of.end(), 0.0);
    }
    double kinetic;  ///< of the liquid at the start [erg]
    EnergyChanges all;
    double unbooked = 0.0;  ///< [erg]
};

/// What the parts of a step give and take is what the energy changes by, up to the error of the solves (sim/README.md, Energy); to look changes
/// nothing.
TEST_P(DropOnCloth, EnergyGoesWhereTheBudgetSays)
{
    Scene scene = dropAndCloth(DragLaw::Nonlinear, GetParam());
    scene.settings.gravity = Vec3(0.0, -981.0, 0.0);
    scene.domain = Shape::box(Vec3(0.0, 0.0, 0.0), Vec3(2.0, 1.6, 2.0));
    Simulation simulation(scene), unwatched(scene);
    const BookedSteps steps(simulation);
    for (int n = 0; n < 30; ++n) unwatched.step(unwatched.state().time + 1.0e-3);
    const EnergyChanges& all = steps.all;
    const double kinetic = steps.kinetic;
    EXPECT_LT(std::abs(steps.unbooked), 1.0e-3 * kinetic);  // vertex, with two Newton iterations: 1e-4; grid: 7e-9
    for (EnergyChange loss : {EnergyChange::Capture, EnergyChange::ToGrid, EnergyChange::Drag, EnergyChange::Implicit}) EXPECT_LT(all[loss], 0.0);
    EXPECT_LT(all[EnergyChange::Drag], -0.01 * kinetic);
    EXPECT_EQ(stateHash(simulation.state()), stateHash(unwatched.state()));
}

/// So it does where solids hold the liquid, whose weight is levelled, and where surface tension acts: faces that fabric is on have the
/// mixture's velocities by then.
TEST_P(DropOnCloth, EnergyOfAPoolGoesWhereTheBudgetSays)
{
    for (const bool isTense : {false, true}) {
        Scene scene = dropAndCloth(DragLaw::Nonlinear, GetParam());
        scene.settings.gravity = Vec3(0.0, -981.0, 0.0);
        scene.settings.liquid.surfaceTensionForce = isTense;
        scene.sources[0].shape = Shape::box(Vec3(0.0, 0.3, 0.0), Vec3(1.2, 0.4, 1.2));
        ObstacleSettings tank;
        tank.name = "tank";
        tank.shape = Shape::box(Vec3(0.0, 1.0, 0.0), Vec3(1.75, 1.25, 1.75)).inverted();
        scene.obstacles.push_back(tank);
        Simulation simulation(scene);
        const BookedSteps steps(simulation);
        const double kinetic = steps.kinetic, unbooked = steps.unbooked;
        std::printf("not booked: %.1e of the kinetic energy\n", unbooked / kinetic);
        EXPECT_LT(std::abs(unbooked), 1.0e-3 * kinetic) << isTense;  // the fabric's Newton iterations, as above
    }
}

TEST_P(DropOnCloth, SameBitsOnAnyNumberOfThreads)
{
    const auto hashOn = [](int threads) {
        return onThreads(threads, [] {
            Simulation simulation(dropAndCloth(DragLaw::Nonlinear, GetParam()));
            for (int n = 1; n <= 15; ++n) simulation.step(n * 1.0e-3);
            return stateHash(simulation.state());
        });
    };
    const std::uint64_t one = hashOn(1);
    for (int threads : {2, 8}) EXPECT_EQ(hashOn(threads), one) << threads;
}

INSTANTIATE_TEST_SUITE_P(Solvers, DropOnCloth, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& tested) { return tested.param == FabricSolver::Vertex ? "Vertex" : "Grid"; });

}  // namespace
}  // namespace sim::test
