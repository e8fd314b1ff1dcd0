// Standing waves over many periods: what the steps do to their energy (liquid/README.md, Reflection).
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// A tank 24 cells long, 48 high and 2 wide, filled 17 cells high on one half and 13 on the other, turned.
struct Tank {
    const char* name;
    Transfer transfer;
    int along, up;  ///< axes
    bool isMirrored;

    Vec3 turned(double length, double height, double width) const
    {
        Vec3 x = Vec3::Constant(width);
        x[along] = length;
        x[up] = height;
        return x;
    }
    Scene scene(double high, double low) const
    {
        constexpr double kCells = 24.0, kHeight = 48.0, kWidth = 2.0, kMiddle = 0.5 * kCells;
        Scene scene = tankScene(transfer, 0.5, turned(kCells, kHeight, kWidth), Vec3::Zero(), turned(kMiddle, isMirrored ? low : high, kWidth));
        SourceSettings other = scene.sources[0];
        const Vec3 from = turned(kMiddle, 0.0, 0.0), to = turned(kCells, isMirrored ? high : low, kWidth);
        Vec3 least = Vec3::Zero();
        least[along] = from[along];
        other.name = "other half";
        other.shape = Shape::box(0.25 * (least + to), 0.25 * (to - least));
        scene.sources.push_back(other);
        scene.settings.gravity = -kEarthGravity * Vec3::Unit(up);
        scene.settings.time.mode = TimeMode::Fixed;
        return scene;
    }
};

constexpr double kPeriod = 0.4;  ///< period of the lowest wave [s]

/// Largest kinetic energies of the first second and of the fifth after it [erg]: that of a wave of which the other half is where it stands highest.
std::array<double, 2> largestKinetic(Scene scene, double dt)
{
    scene.settings.time.dt = dt;
    Simulation simulation(scene);
    std::array<double, 2> largest{};
    while (simulation.state().time < 7.0) {
        const double until = std::floor(simulation.state().time + 1.0 + 1.0e-9);
        const StepReport report = simulation.step(until);
        if (report.isReflected || (until != 2.0 && until != 7.0)) continue;
        double& of = largest[until == 7.0];
        of = std::max(of, report.energies.kinetic);
    }
    return largest;
}

/// A surface that moves in the steps that reflect would pump waves, at a rate that grows with the step and the square of the height. To 2 %, by
/// which the largest energy of five periods is found.
TEST(Waves, AreNotPumpedByStepsOfAnyLength)
{
    for (const Tank& tank : {Tank{"APIC", kApic, 0, 1, false}, Tank{"APIC, turned", kApic, 1, 2, true}, Tank{"PolyPIC-8", kPoly8, 2, 0, true}})
        for (const double perPeriod : {48.0, 32.0}) {
            const auto [first, last] = largestKinetic(tank.scene(16.5, 13.5), kPeriod / perPeriod);
            std::printf("%s, %.0f steps a period: %.0f erg, then %.0f erg\n", tank.name, perPeriod, first, last);
            EXPECT_LT(last, 1.02 * first) << tank.name << ", " << perPeriod << " steps a period";
        }
}

/// A low standing wave of 16 cells, half of it in a tank, which is turned.
struct StillWave {
    Transfer transfer;
    TimeIntegrator integrator;
    double level;   ///< height of the surface at rest [cells]
    int along, up;  ///< axes

    static constexpr double kCell = 0.7, kLength = 8.0 * kCell, kNumber = kPi / kLength, kAmplitude = 0.02 * kLength;
    double frequency() const { return std::sqrt(kEarthGravity * kNumber * std::tanh(kNumber * level * kCell)); }

    Scene scene() const
    {
        const auto turned = [&](double length, double height) {
            Vec3 x = Vec3::Constant(2.0);
            x[along] = length;
            x[up] = height;
            return x;
        };
        Scene scene = tankScene(transfer, kCell, turned(8.0, 16.0), Vec3::Zero(), turned(8.0, level));
        scene.sources[0].fill.spacing = 0.5;
        scene.settings.gravity = -kEarthGravity * Vec3::Unit(up);
        scene.settings.time.mode = TimeMode::Fixed;
        scene.settings.time.dt = 2.0 * kPi / frequency() / 40.0;
        scene.settings.time.integrator = integrator;
        return scene;
    }
    Vec3 velocity(const Vec3& x) const
    {
        const double speed = kAmplitude * frequency() / std::sinh(kNumber * level * kCell);
        return speed * (std::cos(kNumber * x[along]) * std::sinh(kNumber * x[up]) * Vec3::Unit(up) -
                        std::sin(kNumber * x[along]) * std::cosh(kNumber * x[up]) * Vec3::Unit(along));
    }
};

/// How far particles are from where they began after so many periods, relative to the wave's height (root mean squares) [-].
double creep(const StillWave& wave, int periods)
{
    Simulation simulation = moving(wave.scene(), [&](const Vec3& x) { return wave.velocity(x); });
    const auto places = [&] {
        const LiquidParticles& liquid = simulation.state().liquid;
        std::vector<Vec3> x(liquid.count);
        for (std::size_t p = 0; p < liquid.count; ++p) x[liquid.id[p]] = liquid.position(p);
        return x;
    };
    const std::vector<Vec3> start = places();
    const double end = periods * 2.0 * kPi / wave.frequency();
    while (simulation.state().time < end * (1.0 - 1.0e-9)) simulation.step(end);
    const std::vector<Vec3> last = places();
    double sum = 0.0;
    for (std::size_t p = 0; p < start.size(); ++p) sum += (last[p] - start[p]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(start.size())) / StillWave::kAmplitude;
}

/// In a wave that stands each particle goes to and fro, wherever in its cell the surface lies. What cells beside air do not get of the wave in one
/// half of it, and get in the other, would carry the surface to its nodes.
TEST(Creep, ParticlesOfAStandingWaveStayWhereTheyAre)
{
    struct Turn {
        int along, up;
    };
    const std::array<Turn, 3> turns = {{{0, 1}, {1, 2}, {2, 0}}};
    int n = 0;
    for (const Transfer& transfer : {kApic, kPoly8, kPoly27})
        for (const TimeIntegrator integrator : {TimeIntegrator::Plain, TimeIntegrator::Reflected})
            for (const double level : {7.5, 8.0, 8.15, 8.5, 8.75, 8.95}) {
                const Turn turn = turns[n++ % turns.size()];
                const double crept = creep({transfer, integrator, level, turn.along, turn.up}, 5);
                std::printf("%s, %s, %.2f cells: %.3f\n", transfer.name.c_str(), integrator == TimeIntegrator::Plain ? "plain" : "reflected", level,
                            crept);
                EXPECT_LT(crept, 0.45) << transfer.name << ", level " << level;
            }
}

}  // namespace
}  // namespace sim::test
