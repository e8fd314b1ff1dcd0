// fabric.solver: off — pins are led, all else stays, and liquid meets both as it meets fabric that is held.
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

/// A wet sheet, pinned along one edge to what rises from 0.01 s on.
Scene wetSheet(FabricSolver solver)
{
    Scene scene;
    scene.name = "sheet";
    scene.settings.cell = 0.25;
    scene.settings.time.dt = 1.0e-3;
    scene.settings.fabric.solver = solver;
    scene.settings.fabric.contact = false;
    FabricPiece sheet = testing::pieceOf(clothGrid({{11, 9}, {0.2, 0.2}, Vec3(-1.0, 0.0, -0.8)}), testing::wool(), {0.03, 0.03});
    sheet.wetness = 0.4;
    sheet.velocity = {0.0, 3.0, 0.0};
    PinGroup edge;
    for (int v = 0; v < 11; ++v) edge.vertices.push_back(v);
    edge.motion.addTranslation(0.01, 0.05, Vec3(0.0, 1.0, 0.0), 0.0, 0.0);
    sheet.pins.push_back(edge);
    scene.fabrics.push_back(sheet);
    return scene;
}

void addDrop(Scene& scene)
{
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball(Vec3(0.0, 0.8, 0.0), 0.6);
    Emission emission;
    emission.velocity = {0.0, -60.0, 0.0};
    drop.emissions.push_back(emission);
    scene.sources.push_back(drop);
}

double absorbedIn(const Simulation& simulation)
{
    const std::vector<double>& absorbed = simulation.state().fabric.absorbed;
    return std::accumulate(absorbed.begin(), absorbed.end(), 0.0);
}

TEST(PrescribedFabric, IsAsWetAsTheSceneSays)
{
    const Simulation simulation(wetSheet(FabricSolver::Off));
    const Fabric& fabric = simulation.fabric();
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) EXPECT_NEAR(simulation.state().fabric.absorbed[v], 0.4 * poreVolume(fabric, v), 1.0e-15);
}

TEST(PrescribedFabric, PinsFollowTheirMotionsAndAllElseStays)
{
    Simulation simulation(wetSheet(FabricSolver::Off));
    const std::vector<Vec3> start = simulation.state().fabric.x;
    const auto way = [](double t) { return std::clamp((t - 0.01) / 0.04, 0.0, 1.0); };
    for (int n = 1; n <= 60; ++n) {
        const StepReport report = simulation.step(n * 1.0e-3);
        const FabricState& now = simulation.state().fabric;
        for (std::size_t v = 0; v < start.size(); ++v) {
            const bool isLed = v < 11;
            const double rise = isLed ? way(n * 1.0e-3) : 0.0, speed = isLed ? (rise - way((n - 1) * 1.0e-3)) / 1.0e-3 : 0.0;
            ASSERT_NEAR((now.x[v] - start[v]).y(), rise, 1.0e-12);
            ASSERT_NEAR(now.v[v].y(), speed, 1.0e-9);
        }
        EXPECT_EQ(report.energies.fabric.kinetic > 0.0, n > 10 && n <= 50);
    }
}

/// To liquid it is what fabric is of which every vertex is pinned.
TEST(PrescribedFabric, ActsOnLiquidAsFabricThatIsPinnedAllOver)
{
    Scene off = wetSheet(FabricSolver::Off), pinned = wetSheet(FabricSolver::Vertex);
    for (Scene* scene : {&off, &pinned}) {
        addDrop(*scene);
        scene->fabrics[0].pins[0].vertices.resize(99);
        std::iota(scene->fabrics[0].pins[0].vertices.begin(), scene->fabrics[0].pins[0].vertices.end(), 0);
    }
    Simulation one(off), other(pinned);
    one.bookEnergy();
    const double energy = one.energies().total(), wet = absorbedIn(one);
    double booked = 0.0;
    for (int n = 1; n <= 40; ++n) {
        const StepReport report = one.step(n * 1.0e-3), same = other.step(n * 1.0e-3);
        for (double change : report.energyChanges->of) booked += change;
        ASSERT_EQ(report.particles, same.particles);
        ASSERT_NEAR(report.absorbedMass, same.absorbedMass, 1.0e-9 * same.absorbedMass);
        ASSERT_NEAR(report.energies.kinetic, same.energies.kinetic, 1.0e-7 * same.energies.kinetic);
        const double change = report.energies.total() - energy;
        ASSERT_NEAR(change, booked, 1.0e-6 * std::abs(change));
    }
    EXPECT_GT(absorbedIn(one), 1.01 * wet) << "it takes liquid up";
    EXPECT_LT(one.energies().kinetic, 0.5 * 0.5 * one.state().ledger.emittedMass * 3600.0) << "and stops it";
}

TEST(PrescribedFabric, LetsLiquidThroughWithoutDrag)
{
    Scene scene = wetSheet(FabricSolver::Off);
    addDrop(scene);
    Scene free = scene;
    free.settings.coupling.drag = DragLaw::Off;
    const auto heightAfter = [](const Scene& of) {
        Simulation simulation(of);
        for (int n = 1; n <= 20; ++n) simulation.step(n * 1.0e-3);
        double lowest = 1.0e9;
        for (std::size_t p = 0; p < simulation.state().liquid.count; ++p) lowest = std::min(lowest, simulation.state().liquid.position(p).y());
        return lowest;
    };
    EXPECT_LT(heightAfter(free), heightAfter(scene) - 0.1);
}

}  // namespace
}  // namespace sim::test
