#include "tests/physics/vortex_run.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// Part of the vortex's energy that is left after one turnover, 2π s.
double energyKept(const Transfer& transfer)
{
    Simulation simulation = moving(vortexScene(transfer, 0.1, TimeIntegrator::Plain), vortex);
    const double start = simulation.energies().total();
    StepReport report;
    while (simulation.state().time < 2.0 * kPi) {
        report = simulation.step(2.0 * kPi);
        EXPECT_TRUE(report.pressure.converged);
        EXPECT_LT(report.maxSpeed, 2.0);
    }
    std::printf("%s: energy kept %.4f after %ld steps\n", transfer.name.c_str(), report.energies.total() / start,
                static_cast<long>(simulation.state().step));
    return report.energies.total() / start;
}

/// What is left in the periodic flow of which the box is a part, by the two-dimensional study of the time splitting.
TEST(TaylorGreen, KeepsTheEnergyOfThePeriodicVortex)
{
    const double pic = energyKept(kPic), apic = energyKept(kApic), poly8 = energyKept(kPoly8), poly27 = energyKept(kPoly27);
    EXPECT_LT(pic, 0.01);
    EXPECT_NEAR(apic, 0.867, 0.015);
    EXPECT_NEAR(poly8, 0.940, 0.015);
    EXPECT_NEAR(poly27, 0.943, 0.015);
    EXPECT_LT(apic, poly8);
    EXPECT_LT(poly8, poly27);
}

TEST(TaylorGreen, AllModesLoseAQuarterOfWhatApicLoses)
{
    const auto lost = [](const Transfer& transfer) {
        const VortexEnd end = turnVortex(gathered(vortexScene(transfer, 0.25, TimeIntegrator::Reflected), vortex));
        std::printf("%s, CFL 0.25, reflected: energy lost %.4f, error %.4f\n", transfer.name.c_str(), 1.0 - end.kept, end.error);
        return 1.0 - end.kept;
    };
    const double apic = lost(kApic), poly27 = lost(kPoly27);
    EXPECT_GT(poly27, 0.0);
    EXPECT_LT(poly27, 0.25 * apic);
}

/// Σ m (x × v) of the particles, and what their gradients carry: m dx/4 times twice the rotation [g cm²/s].
Vec3 angularMomentum(const State& state)
{
    const LiquidParticles& liquid = state.liquid;
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 x = liquid.position(p), v = liquid.velocity(p);
        Vec3 own = x.cross(v);
        if (liquid.modeCount >= 4) {
            const auto slope = [&](int component, int along) { return liquid.mode(component, 1 + along)[p]; };
            for (int a = 0; a < kAxes; ++a) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                own[a] += 0.25 * state.grid.dx * (slope(c, b) - slope(b, c));
            }
        }
        sum += liquid.mass[p] * own;
    }
    return sum;
}

/// Largest change of the angular momentum of a turning ball of radius 8 cm in one of 20 steps, relative to its start.
double largestChange(const Transfer& transfer, TimeIntegrator integrator, double cell, double dt)
{
    const Vec3 middle(0.3, -0.2, 0.1), turn(0.3, -0.2, 1.0);
    Scene scene;
    scene.settings.cell = cell;
    scene.settings.gravity = Vec3::Zero();
    scene.settings.transfer.method = transfer.method;
    scene.settings.transfer.modes = transfer.modes;
    scene.settings.liquid.volume.rate = 0.0;
    scene.settings.solver.pressureTolerance = 1.0e-12;
    scene.settings.time.dt = dt;
    scene.settings.time.integrator = integrator;
    SourceSettings source;
    source.shape = Shape::ball(middle, 8.0);
    source.emissions.push_back({});
    scene.sources.push_back(source);
    Simulation simulation = moving(scene, [&](const Vec3& x) { return Vec3(turn.cross(x - middle)); });
    const Vec3 start = angularMomentum(simulation.state());
    Vec3 last = start;
    double worst = 0.0;
    for (int step = 0; step < 20; ++step) {
        simulation.step(1.0e9);
        const Vec3 now = angularMomentum(simulation.state());
        worst = std::max(worst, (now - last).norm() / start.norm());
        last = now;
    }
    std::printf("%s, cell %.1f, dt %.3f: angular momentum changes by up to %.2e per step, by %.2e in 20\n", transfer.name.c_str(), cell, dt, worst,
                (last - start).norm() / start.norm());
    return worst;
}

TEST(RotatingBlob, KeepsItsAngularMomentum)
{
    // To rounding where all faces of liquid cells are fuller than kLeastFill, else to what that floor takes.
    for (const auto& [transfer, integrator] : {std::pair(kApic, TimeIntegrator::Reflected), std::pair(kPoly8, TimeIntegrator::Plain),
                                               std::pair(kPoly8, TimeIntegrator::Reflected), std::pair(kPoly27, TimeIntegrator::Reflected)}) {
        EXPECT_LT(largestChange(transfer, integrator, 1.0, 0.02), 1.0e-6) << transfer.name;
        EXPECT_LT(largestChange(transfer, integrator, 0.5, 0.01), 1.0e-6) << transfer.name;
    }
}

}  // namespace
}  // namespace sim::test
