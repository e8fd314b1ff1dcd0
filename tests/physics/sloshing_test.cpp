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

/// A low standing wave of one wavelength in `cells`, half of which is in the tank, in steps of a tenth of a cell's share of its period.
struct LowWave {
    static constexpr double kAmplitude = 0.01;  ///< of the wavelength

    int cells;
    int surfaceOrder;
    Transfer transfer = kPoly8;
    TimeIntegrator integrator = TimeIntegrator::Reflected;
    StandingWave wave{0.5 * cells};

    Scene scene() const
    {
        Scene scene = wave.scene(transfer, 1.0);
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = wave.period / (10.0 * cells);
        scene.settings.time.integrator = integrator;
        scene.settings.liquid.surfaceOrder = surfaceOrder;
        scene.sources[0].fill.spacing = 0.5;  // others than a divisor of the cell shift the periods of low waves by up to 2 %
        return scene;
    }
    Vec3 velocity(const Vec3& x) const { return kAmplitude / 0.02 * wave.velocity(x); }
    /// Of waves that are not infinitely low (Stokes): (k a)²/8.
    double finiteAmplitude() const { return std::pow(2.0 * kPi * kAmplitude, 2) / 8.0; }
};

/// A damped oscillation about a level: e^{−damping t} (sine sin ω t + cosine cos ω t) + level.
struct Oscillation {
    double frequency, damping = 0.0, sine = 0.0, cosine = 0.0, level = 0.0;

    /// Least squares, by Gauss and Newton from a frequency that is nearly right.
    void fit(const std::vector<double>& times, const std::vector<double>& values)
    {
        using Vector = Eigen::Matrix<double, 5, 1>;
        for (int round = 0; round < 12; ++round) {
            Eigen::Matrix<double, 5, 5> square = Eigen::Matrix<double, 5, 5>::Zero();
            Vector right = Vector::Zero();
            for (std::size_t i = 0; i < times.size(); ++i) {
                const double t = times[i], fade = std::exp(-damping * t), s = fade * std::sin(frequency * t), c = fade * std::cos(frequency * t);
                const double wave = sine * s + cosine * c;
                Vector row;
                row << t * (sine * c - cosine * s), -t * wave, s, c, 1.0;
                if (round == 0) row[0] = row[1] = 0.0;  // the amplitudes first
                square += row * row.transpose();
                right += row * (values[i] - wave - level);
            }
            if (round == 0) square(0, 0) = square(1, 1) = 1.0;
            const Vector step = square.ldlt().solve(right);
            frequency += step[0], damping += step[1], sine += step[2], cosine += step[3], level += step[4];
        }
    }
};

Sloshing sloshLow(const LowWave& low, double periods)
{
    const double period = low.wave.period;
    Simulation simulation = moving(low.scene(), [&](const Vec3& x) { return low.velocity(x); });
    std::vector<double> times, values;
    while (simulation.state().time < periods * period) {
        const StepReport report = simulation.step(periods * period);
        if (report.isReflected) continue;
        const LiquidParticles& liquid = simulation.state().liquid;
        double sum = 0.0;
        for (std::size_t p = 0; p < liquid.count; ++p) sum += liquid.mass[p] * std::cos(low.wave.number * liquid.x[0][p]);
        times.push_back(simulation.state().time);
        values.push_back(sum);
    }
    Oscillation fit{low.wave.frequency};
    fit.fit(times, values);
    return {low.wave.frequency / fit.frequency - 1.0 - low.finiteAmplitude(), std::exp(-fit.damping * period)};
}

/// The grid carries the mass of the liquid spread by the B-spline, of variance dx²/4, over a surface above which the
/// wave's velocity grows like exp(k y). Without the strain correction that makes its inertia exp(k² dx²/2) times larger: second order, and the
/// same for every transfer.
double expectedPeriodError(int cellsPerWave)
{
    const double kDx = 2.0 * kPi / cellsPerWave;
    return std::exp(0.25 * kDx * kDx) - 1.0;
}

/// A higher wave, in longer steps: period and its bound are those of the linear one within what its height, (k a)²/8, and the steps change.
TEST(Sloshing, PeriodIsThatOfALinearWave)
{
    for (const Transfer& transfer : {kFlip, kApic, kPoly8, kPoly27}) {
        const Sloshing result = slosh(transfer, 16, 0.5, 3);
        std::printf("%s: period %+.2f %%, amplitude kept per period %.3f\n", transfer.name.c_str(), 100.0 * result.periodError, result.kept);
        EXPECT_NEAR(result.periodError, 0.0, 0.015) << transfer.name;
    }
    for (const Transfer& transfer : {kApic, kPoly8}) {
        const Sloshing fine = slosh(transfer, 24, 0.5, 2);
        std::printf("%s, 24 cells per wave: period %+.2f %%, amplitude kept per period %.3f\n", transfer.name.c_str(), 100.0 * fine.periodError,
                    fine.kept);
        EXPECT_NEAR(fine.periodError, 0.0, 0.01) << transfer.name;
    }
}

double lowWaveError(const LowWave& low)
{
    const Sloshing result = sloshLow(low, 3.0);
    std::printf("%s, %s, order %d, %d cells per wave: period %+.3f %%, amplitude kept per period %.3f\n", low.transfer.name.c_str(),
                low.integrator == TimeIntegrator::Plain ? "plain" : "reflected", low.surfaceOrder, low.cells, 100.0 * result.periodError,
                result.kept);
    return result.periodError;
}

/// Without the inertia of stretching what is left is the divergence of interpolated velocities, (k dx)²/48, and of fourth order what the lattice of the
/// particles, the faces beyond the surface and the correction of the volume do to waves of less than .3 cells.
TEST(Sloshing, PeriodOfLowWavesIsOfSecondOrder)
{
    double coarsest = 0.0, finest = 0.0;
    for (const int cells : {12, 16, 24, 32}) {
        const double kDx = 2.0 * kPi / cells;
        const double error = finest = lowWaveError({cells, 2});
        if (cells == 12) coarsest = error;
        EXPECT_NEAR(error, kDx * kDx / 48.0, 0.3 * std::pow(kDx, 4)) << cells;
    }
    EXPECT_LT(std::abs(finest), 1.3e-3);
    EXPECT_GT(std::log(std::abs(coarsest / finest)) / std::log(32.0 / 12.0), 1.8);
    for (const Transfer& transfer : {kApic, kPoly8, kPoly27}) EXPECT_LT(std::abs(lowWaveError({16, 2, transfer})), 9.0e-3) << transfer.name;
    EXPECT_LT(std::abs(lowWaveError({16, 2, kPoly8, TimeIntegrator::Plain})), 9.0e-3);
}

/// As published it has the inertia of stretching; what shortens the periods of low waves otherwise is as large as with order 2.
TEST(Sloshing, PeriodOfFirstOrderIsThatOfTheSmearedMass)
{
    for (const int cells : {16, 24}) EXPECT_NEAR(lowWaveError({cells, 1}), expectedPeriodError(cells), 6.0e-3) << cells;
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
