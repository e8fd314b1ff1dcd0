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

}  // namespace
}  // namespace sim::test
