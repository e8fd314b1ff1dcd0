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

/// Σ m (x × v) of the particles, and what their linear modes carry: m dx/4 times twice the rotation [g cm²/s]. Those are
/// orthogonal to modes of higher degrees, which carry none.
Vec3 angularMomentum(const State& state)
{
    const LiquidParticles& liquid = state.liquid;
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < liquid.count; ++p) {
        Mat3 slope = Mat3::Zero();
        for (int component = 0; component < kAxes; ++component) {
            Modes c{};
            for (int r = 0; r < liquid.modeCount; ++r) c[r] = liquid.mode(component, r)[p];
            c = toOrthogonal(Stencil(state.grid, component, liquid.position(p)).basis, c);
            for (int along = 0; along < kAxes; ++along) slope(component, along) = c[1 + along];
        }
        Vec3 own = liquid.position(p).cross(liquid.velocity(p));
        for (int a = 0; a < kAxes; ++a) own[a] += 0.25 * state.grid.dx * (slope((a + 2) % 3, (a + 1) % 3) - slope((a + 1) % 3, (a + 2) % 3));
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

Vec3 momentum(const State& state)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t p = 0; p < state.liquid.count; ++p) sum += state.liquid.mass[p] * state.liquid.velocity(p);
    return sum;
}

/// A box of 10 × 8 × 12 cells that nothing holds, thick enough for deep cells, spins and is stretched, so that there is pressure in all of it.
Simulation freeBox(const Transfer& transfer, TimeIntegrator integrator)
{
    const Vec3 middle(0.13, -0.27, 0.11), turn(0.5, -0.8, 1.0);
    Scene scene;
    scene.settings.cell = 1.0;
    scene.settings.gravity = Vec3::Zero();
    scene.settings.transfer.method = transfer.method;
    scene.settings.transfer.modes = transfer.modes;
    scene.settings.time.dt = 0.02;
    scene.settings.time.integrator = integrator;
    scene.settings.liquid.volume.rate = 0.0;
    SourceSettings source;
    source.shape = Shape::box(middle, {5.0, 4.0, 6.0});
    source.emissions.push_back({});
    scene.sources.push_back(source);
    return moving(scene, [&](const Vec3& x) { return Vec3(turn.cross(x - middle) + (x - middle).cwiseProduct(Vec3(0.4, 0.3, -0.7))); });
}

/// Free liquid keeps both momenta to rounding with deep cells in it, too. When those counted as full the angular one changed by 5e-5.
TEST(FreeBox, KeepsBothMomenta)
{
    for (const Transfer& transfer : {kApic, kPoly8, kPoly27})
        for (const TimeIntegrator integrator : {TimeIntegrator::Plain, TimeIntegrator::Reflected}) {
            Simulation simulation = freeBox(transfer, integrator);
            double scale = 0.0, arm = 0.0;
            for (std::size_t p = 0; p < simulation.state().liquid.count; ++p) {
                const double part = simulation.state().liquid.mass[p] * simulation.state().liquid.velocity(p).norm();
                scale += part;
                arm += part * simulation.state().liquid.position(p).norm();
            }
            const Vec3 linear = momentum(simulation.state()), angular = angularMomentum(simulation.state());
            double linearDrift = 0.0, angularDrift = 0.0;
            for (int step = 0; step < 60; ++step) {
                simulation.step(1.0e9);
                linearDrift = std::max(linearDrift, (momentum(simulation.state()) - linear).norm() / scale);
                angularDrift = std::max(angularDrift, (angularMomentum(simulation.state()) - angular).norm() / arm);
            }
            std::printf("%s, %s: momentum changes by up to %.1e, angular momentum by %.1e\n", transfer.name.c_str(),
                        integrator == TimeIntegrator::Plain ? "plain" : "reflected", linearDrift, angularDrift);
            EXPECT_LT(linearDrift, 1.0e-13) << transfer.name;
            // What quadratic modes have of rotation goes by where the particle is in its cell.
            EXPECT_LT(angularDrift, transfer.modes > 8 ? 2.0e-5 : 1.0e-13) << transfer.name;
        }
}

}  // namespace
}  // namespace sim::test
