#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <numeric>

namespace sim::test {
namespace {

TEST(WholeStep, SameBitsForAnyThreadCount)
{
    for (const Transfer& transfer : kTransfers) {
        const auto hashAfter30Steps = [&] {
            Simulation simulation(ballIntoPool(transfer));
            for (int step = 0; step < 30; ++step) simulation.step(1.0e9);
            return stateHash(simulation.state());
        };
        const std::uint64_t one = onThreads(1, hashAfter30Steps);
        EXPECT_EQ(one, onThreads(2, hashAfter30Steps)) << transfer.name;
        EXPECT_EQ(one, onThreads(8, hashAfter30Steps)) << transfer.name;
    }
}

TEST(WholeStep, ReflectsWithTheSameBitsForAnyThreadCount)
{
    const Scene scene = ballIntoPool(kPoly8);
    ASSERT_TRUE(scene.settings.time.reflects());
    const auto hashAfter30Steps = [&] {
        Simulation simulation(scene);
        for (int step = 0; step < 30; ++step) simulation.step(1.0e9);
        return stateHash(simulation.state());
    };
    const std::uint64_t one = onThreads(1, hashAfter30Steps);
    EXPECT_EQ(one, onThreads(2, hashAfter30Steps));
    EXPECT_EQ(one, onThreads(8, hashAfter30Steps));
}

State permuted(const State& state, unsigned seed)
{
    State result = state;
    std::vector<std::size_t> from(state.liquid.count);
    std::iota(from.begin(), from.end(), 0);
    std::shuffle(from.begin(), from.end(), std::mt19937(seed));
    for (std::size_t p = 0; p < from.size(); ++p) {
        result.liquid.mass[p] = state.liquid.mass[from[p]];
        result.liquid.id[p] = state.liquid.id[from[p]];
        for (int a = 0; a < kAxes; ++a) {
            result.liquid.x[a][p] = state.liquid.x[a][from[p]];
            for (int r = 0; r < state.liquid.modeCount; ++r) result.liquid.mode(a, r)[p] = state.liquid.mode(a, r)[from[p]];
        }
    }
    return result;
}

/// Largest difference of positions [cm] after `steps` steps from the same particles in another order.
double differenceByOrder(const Scene& scene, int steps)
{
    Simulation warm(scene);
    for (int step = 0; step < 10; ++step) warm.step(1.0e9);
    const auto run = [&](State state) {
        Simulation simulation(scene, std::move(state));
        for (int step = 0; step < steps; ++step) simulation.step(1.0e9);
        return simulation.state();
    };
    const State one = run(warm.state()), other = run(permuted(warm.state(), 7));
    EXPECT_EQ(one.liquid.count, other.liquid.count);
    std::vector<std::size_t> byId(one.nextId, 0);
    for (std::size_t p = 0; p < one.liquid.count; ++p) byId[one.liquid.id[p]] = p;
    double worst = 0.0;
    for (std::size_t p = 0; p < other.liquid.count; ++p)
        worst = std::max(worst, (other.liquid.position(p) - one.liquid.position(byId[other.liquid.id[p]])).norm());
    return worst;
}

TEST(WholeStep, OrderOfTheParticlesDoesNotMatter)
{
    for (const Transfer& transfer : kTransfers) {
        Scene scene = ballIntoPool(transfer);
        scene.settings.solver.pressureTolerance = 1.0e-11;
        EXPECT_LT(differenceByOrder(scene, 10), 1.0e-9) << transfer.name;
        // Relaxation adds up floats; crowded particles then double a difference in each step.
        scene.settings.liquid.relax.rate = 125.0;
        EXPECT_LT(differenceByOrder(scene, 1), 1.0e-7) << transfer.name;
    }
}

TEST(WholeStep, ReportTellsTheEnergiesOfTheState)
{
    for (const Transfer& transfer : kTransfers) {
        Simulation simulation(ballIntoPool(transfer));
        for (int step = 0; step < 5; ++step) {
            const StepReport report = simulation.step(1.0e9);
            const Energies now = simulation.energies();
            // G2P sums where the particles were: only the potential is that of where they are now.
            EXPECT_NEAR(report.energies.kinetic, now.kinetic, 1.0e-12 * now.kinetic) << transfer.name;
            EXPECT_NEAR(report.energies.potential, now.potential, 1.0e-12 * now.potential) << transfer.name;
            EXPECT_NEAR(report.energies.modal, now.modal, 0.02 * now.modal + 1.0e-6 * now.kinetic) << transfer.name;
        }
    }
}

TEST(WholeStep, StateAloneDecidesWhatFollows)
{
    Simulation simulation(ballIntoPool(kPoly8));
    for (int step = 0; step < 10; ++step) simulation.step(1.0e9);
    Simulation restarted(ballIntoPool(kPoly8), simulation.state());
    for (int step = 0; step < 10; ++step) {
        simulation.step(1.0e9);
        restarted.step(1.0e9);
        ASSERT_EQ(stateHash(simulation.state()), stateHash(restarted.state())) << "step " << step;
    }
}

}  // namespace
}  // namespace sim::test
