#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

struct Sloshing {
    double periodError;  ///< relative to the linear wave's
    double kept;         ///< amplitude per period
};

/// The amplitude of a standing wave is read from Σ m cos(k x).
Sloshing slosh(const Transfer& transfer, int cellsPerWave, double cfl, int periods)
{
    const StandingWave wave{0.5 * cellsPerWave};
    const double period = wave.period;
    Simulation simulation = moving(wave.scene(transfer, cfl), [&](const Vec3& x) { return wave.velocity(x); });
    const auto reading = [&] {
        const LiquidParticles& liquid = simulation.state().liquid;
        double sum = 0.0;
        for (std::size_t p = 0; p < liquid.count; ++p) sum += liquid.mass[p] * std::cos(wave.number * liquid.x[0][p]);
        return sum;
    };
    const double zero = reading();
    double last = 0.0, lastTime = 0.0, peak = 0.0;
    std::vector<double> crossings, peaks;
    while (simulation.state().time < periods * period * 1.02) {
        simulation.step(periods * period * 1.05);
        const double now = reading() - zero, time = simulation.state().time;
        if (last * now < 0.0) {
            crossings.push_back(lastTime + (time - lastTime) * last / (last - now));
            peaks.push_back(peak);
            peak = 0.0;
        }
        peak = std::max(peak, std::abs(now));
        last = now, lastTime = time;
    }
    if (crossings.size() < 3) return {1.0, 0.0};
    // Crossing n comes after (n + 1)/2 periods.
    const double measured = 2.0 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    const double kept = std::pow(peaks.back() / peaks.front(), 2.0 / static_cast<double>(peaks.size() - 1));
    return {measured / period - 1.0, kept};
}

/// The grid carries the mass of the liquid spread by the B-spline, of variance dx²/4, over a surface above which the
/// wave's velocity grows like exp(k y). That makes its inertia exp(k² dx²/2) times larger: second order, and the same
/// for every transfer.
double expectedPeriodError(int cellsPerWave)
{
    const double kDx = 2.0 * kPi / cellsPerWave;
    return std::exp(0.25 * kDx * kDx) - 1.0;
}

TEST(Sloshing, PeriodIsThatOfALinearWave)
{
    for (const Transfer& transfer : {kFlip, kApic, kPoly8, kPoly27}) {
        const Sloshing result = slosh(transfer, 16, 0.5, 3);
        std::printf("%s: period %+.2f %% (expected %+.2f), amplitude kept per period %.3f\n", transfer.name.c_str(), 100.0 * result.periodError,
                    100.0 * expectedPeriodError(16), result.kept);
        EXPECT_NEAR(result.periodError, expectedPeriodError(16), 0.01) << transfer.name;
    }
    for (const Transfer& transfer : {kApic, kPoly8}) {
        const Sloshing fine = slosh(transfer, 24, 0.5, 2);
        std::printf("%s, 24 cells per wave: period %+.2f %%, amplitude kept per period %.3f\n", transfer.name.c_str(), 100.0 * fine.periodError,
                    fine.kept);
        EXPECT_NEAR(fine.periodError, expectedPeriodError(24), 0.01);
        EXPECT_LT(std::abs(fine.periodError), 0.03);
    }
}

TEST(Sloshing, RicherModesDecayMoreSlowly)
{
    double kept = 0.0;
    for (const Transfer& transfer : {kPic, kApic, kPoly8, kPoly27}) {
        const Sloshing result = slosh(transfer, 16, 0.125, 3);
        std::printf("%s: period %+.2f %%, amplitude kept per period %.3f\n", transfer.name.c_str(), 100.0 * result.periodError, result.kept);
        EXPECT_GT(result.kept, kept) << transfer.name;
        kept = result.kept;
    }
    EXPECT_LT(kept, 1.01);
}

}  // namespace
}  // namespace sim::test
