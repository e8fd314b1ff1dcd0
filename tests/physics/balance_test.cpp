#include "tests/physics/runs.h"

#include <gtest/gtest.h>

#include <map>

namespace sim::test {
namespace {

TEST(FreeFall, BlobFallsWithExactlyGravityAndKeepsItsShape)
{
    for (const Transfer& transfer : kTransfers) {
        Scene scene;
        scene.settings.cell = 0.288;
        scene.settings.transfer.method = transfer.method;
        scene.settings.transfer.modes = transfer.modes;
        scene.settings.liquid.relax.rate = 0.0;
        scene.settings.time.dt = 1.0e-3;
        SourceSettings source;
        source.shape = Shape::ball({0.3, -0.2, 0.1}, 1.3);
        source.emissions.push_back({});
        scene.sources.push_back(source);
        Simulation simulation(scene);
        SCOPED_TRACE(transfer.name);
        double time = 0.0, last = 0.0;
        for (int step = 0; step < 100; ++step) time += last = simulation.step(0.1).dt;
        const State& state = simulation.state();
        const Vec3 expected(0.0, -kEarthGravity * (time - 0.5 * last), 0.0);  // halfway through the last step
        double worst = 0.0, pressure = 0.0;
        for (std::size_t p = 0; p < state.liquid.count; ++p) worst = std::max(worst, (state.liquid.velocity(p) - expected).norm());
        for (int b = 0; b < state.grid.count(); ++b)
            for (int c = 0; c < kBlockCells; ++c) pressure = std::max(pressure, std::abs(state.pressure.block(b)[c]));
        EXPECT_LT(worst, 1.0e-9) << transfer.name;
        EXPECT_LT(pressure, 1.0e-6) << transfer.name;
    }
}

/// Largest gain within a tenth of a second, relative to the start. What the store of stretching gives is no gain.
double largestGain(Simulation& simulation, double duration)
{
    const auto all = [](const Energies& energies) { return energies.total() + energies.strain; };
    std::vector<std::pair<double, double>> history = {{0.0, all(simulation.energies())}};
    double gain = 0.0;
    while (simulation.state().time < duration) {
        const StepReport report = simulation.step(duration);
        if (report.isReflected) continue;
        history.emplace_back(simulation.state().time, all(report.energies));
        for (auto then = history.rbegin(); then != history.rend() && then->first > history.back().first - 0.1; ++then)
            gain = std::max(gain, history.back().second - then->second);
    }
    return gain / history.front().second;
}

/// Energy above that of liquid resting on the floor, whose potential is 0.
TEST(Energy, DoesNotGrowBetweenWallsAtRest)
{
    for (const TimeIntegrator integrator : {TimeIntegrator::Plain, TimeIntegrator::Reflected})
        for (const Transfer& transfer : {kPic, kApic, kPoly8, kPoly27}) {
            constexpr double kCell = 0.625;
            Scene scene = tankScene(transfer, kCell, Vec3(24.0, 30.0, 2.5) / kCell, Vec3::Zero(), Vec3(10.0, 12.0, 2.5) / kCell);
            scene.sources[0].fill.spacing = 0.5;
            scene.settings.time.cfl = 0.5;
            scene.settings.time.integrator = integrator;
            if (integrator == TimeIntegrator::Reflected) {
                scene.settings.time.dt = 2.0e-3;          // energies are taken halfway through steps: the first one would be seen
                scene.settings.liquid.volume.rate = 0.0;  // it lifts, by more than plain steps lose of what they fall too far
            }
            Simulation simulation(scene);
            const double start = simulation.energies().total(), gain = largestGain(simulation, 0.4);
            std::printf("%s: largest gain in 0.1 s %.2e, energy left after 0.4 s %.3f\n", transfer.name.c_str(), gain,
                        simulation.energies().total() / start);
            // Plain steps gain nothing. With reflection liquid that climbs the far wall does: 1.6e-3 with 8 modes, 1.3e-3 with 27. The half of it is the
            // step's, as the impact is split in halves at different times, and 1.2e-3 is there in steps of a quarter, with the surface's motion heeded
            // and without: weight is levelled in the surface layer, whose noise stores it. At this step both errors had opposite signs before.
            EXPECT_LT(gain, integrator == TimeIntegrator::Plain ? 1.0e-4 : 2.0e-3) << transfer.name;
        }
}

TEST(Volume, MassesStayAndTheLedgerAddsUp)
{
    Scene scene = coarseDamBreak(kPoly8);
    scene.obstacles.clear();
    scene.obstacles.push_back(obstacle("floor", Shape::box({0.0, -5.0, 0.0}, {100.0, 5.0, 100.0})));
    scene.domain = Shape::box({0.0, 10.0, 0.0}, {20.0, 30.0, 20.0});
    SourceSettings jet;
    jet.shape = Shape::box({5.0, 16.0, 2.0}, {1.0, 1.0, 1.0});
    Emission emission;
    emission.to = 1.0;
    emission.velocity = {60.0, 0.0, 0.0};
    jet.emissions.push_back(emission);
    scene.sources.push_back(jet);
    Simulation simulation(scene);
    std::map<std::uint32_t, double> massOf;
    const auto check = [&] {
        const LiquidParticles& liquid = simulation.state().liquid;
        double sum = 0.0;
        for (std::size_t p = 0; p < liquid.count; ++p) {
            const auto [known, isNew] = massOf.emplace(liquid.id[p], liquid.mass[p]);
            ASSERT_EQ(known->second, liquid.mass[p]);
            sum += liquid.mass[p];
        }
        const Ledger& ledger = simulation.state().ledger;
        ASSERT_NEAR(sum + ledger.leftMass, ledger.emittedMass, 1.0e-12 * ledger.emittedMass);
    };
    const std::size_t atStart = simulation.state().liquid.count;
    check();
    while (simulation.state().time < 0.4) {
        simulation.step(0.4);
        check();
    }
    EXPECT_GT(simulation.state().ledger.leftMass, 0.0);
    EXPECT_GT(massOf.size(), atStart);
}

/// Mean of |fill − 1| over the deep cells, and the largest value.
std::pair<double, double> errorOfVolume(const Simulation& simulation)
{
    const LiquidGrid& liquid = simulation.workspace().grid;
    double sum = 0.0, largest = 0.0;
    int cells = 0;
    for (int b = 0; b < simulation.state().grid.count(); ++b)
        for (int c = 0; c < kBlockCells; ++c) {
            if (!liquid.deep.test(b, c)) continue;
            const double error = std::abs(liquid.fill.block(b)[c] - 1.0);
            sum += error;
            largest = std::max(largest, error);
            ++cells;
        }
    EXPECT_GT(cells, 100);
    return {sum / cells, largest};
}

TEST(Volume, LiquidThatFellOverFillsItsCellsWhateverTheStep)
{
    for (const Transfer& transfer : {kFlip, kApic, kPoly8, kPoly27})
        for (double dt : {1.0e-3, 4.0e-3, 1.0}) {
            Scene scene = coarseDamBreak(transfer);
            scene.settings.time.dt = dt;
            Simulation simulation(scene);
            while (simulation.state().time < 2.0) simulation.step(2.0);
            const auto [mean, largest] = errorOfVolume(simulation);
            std::printf("%s, dt at most %g s: volume of cells off by %.1f %%, at most %.0f %%\n", transfer.name.c_str(), dt, 100.0 * mean,
                        100.0 * largest);
            EXPECT_LT(mean, 0.03) << transfer.name << " at " << dt;
        }
}

TEST(Stability, CoarseDamBreakSurvivesEveryTransferAndStepSize)
{
    for (const Transfer& transfer : kTransfers) {
        std::printf("%-11s", transfer.name.c_str());
        for (double cfl : {0.125, 0.5, 1.0, 3.0}) {
            Scene scene = coarseDamBreak(transfer);
            scene.settings.time.cfl = cfl;
            Simulation simulation(scene);
            const double start = simulation.energies().total();
            double largest = 0.0;
            StepReport report;
            for (int step = 0; step < 1000; ++step) {
                report = simulation.step(1.0e9);
                EXPECT_TRUE(report.pressure.converged) << transfer.name << " at CFL " << cfl << ", step " << step;
                largest = std::max(largest, report.energies.total());
            }
            std::printf("  CFL %.3f: largest %.3f, last %.3f at %.2f s", cfl, largest / start, report.energies.total() / start,
                        simulation.state().time);
            EXPECT_LT(largest, 1.02 * start) << transfer.name << " at CFL " << cfl;
        }
        std::printf("\n");
    }
}

}  // namespace
}  // namespace sim::test
