// Water in a yarn turns with it.
#include "sim/fabric/pieces/generators.h"
#include "sim/simulation.h"
#include "tests/sim/fabric/pieces.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

class WetTwist : public ::testing::TestWithParam<FabricSolver> {};

/// A free straight yarn of two edges, one turned against the other by φ0: after a step h of backward Euler φ = φ0 / (1 + h² k (1/J + 1/J)),
/// with k = χ G I_t / l and, in each edge of mass m and water w, J = ¼ (m + w)(a² + b²).
TEST_P(WetTwist, SlowsWithTheInertiaOfTheWater)
{
    constexpr double kLength = 0.4, kRadius = 0.05, kTwist = 1.0e-3;  // of an edge [cm]; [rad]
    for (const double wetness : {0.0, 0.6, 1.0}) {
        Scene scene;
        scene.name = "yarn";
        scene.settings.cell = 0.25;
        scene.settings.gravity.setZero();
        scene.settings.fabric.solver = GetParam();
        scene.settings.fabric.contact = false;
        scene.settings.fabric.tolerance = 1.0e-8;
        scene.settings.coupling.wicking.rateScale = 0.0;
        scene.settings.coupling.drip = false;
        FabricPiece yarn = testing::pieceOf(strand(Vec3::Zero(), Vec3(2.0 * kLength, 0.0, 0.0), 2), testing::wool(), {kRadius, kRadius});
        yarn.wetness = wetness;
        scene.fabrics.push_back(yarn);
        const FabricMaterial& wool = yarn.material;
        const double volume = kPi * kRadius * kRadius * kLength, fraction = wool.volumeFraction;
        const double mass = volume * (wool.density * fraction + wetness * (1.0 - fraction));  // water has 1 g/cm^3
        const double inertia = 0.5 * mass * kRadius * kRadius;
        const double stiffness = wool.packing() * wool.shear() * 0.5 * kPi * std::pow(kRadius, 4) / kLength;
        const double h = std::sqrt(inertia / stiffness);

        State state = Simulation(scene).state();
        state.fabric.theta[1] = kTwist;
        scene.settings.time.dt = h;
        Simulation simulation(scene, std::move(state));
        simulation.step(h);
        const FabricState& now = simulation.state().fabric;
        EXPECT_NEAR(now.theta[1] - now.theta[0], kTwist / (1.0 + 2.0 * h * h * stiffness / inertia), 1.0e-6 * kTwist) << wetness;
        EXPECT_NEAR(simulation.energies().fabric.kinetic, 0.5 * inertia * (now.omega[0] * now.omega[0] + now.omega[1] * now.omega[1]),
                    1.0e-6 * simulation.energies().fabric.kinetic);
    }
}

/// What spins in water that it takes up keeps J ω. No drag acts on a twist.
TEST_P(WetTwist, KeepsItsMomentumWhileYarnTakesUpWater)
{
    Scene scene;
    scene.name = "spinning yarn";
    scene.settings.cell = 0.25;
    scene.settings.time.dt = 1.0e-3;
    scene.settings.gravity.setZero();
    scene.settings.fabric.solver = GetParam();
    scene.settings.coupling.wicking.rateScale = 0.0;
    scene.settings.coupling.drip = false;
    scene.settings.coupling.capture.rate = 100.0;  // 1/s: half full after five steps
    scene.fabrics.push_back(testing::pieceOf(strand(Vec3(-0.4, 0.0, 0.0), Vec3(0.4, 0.0, 0.0), 4), testing::wool(), {0.05, 0.05}));
    SourceSettings drop;
    drop.name = "drop";
    drop.shape = Shape::ball(Vec3::Zero(), 0.8);
    drop.emissions.push_back({});
    scene.sources.push_back(drop);

    State state = Simulation(scene).state();
    for (double& omega : state.fabric.omega) omega = 50.0;  // 1/s
    Simulation simulation(scene, std::move(state));
    const auto spin = [&](auto&& of) {
        const FabricState& fabric = simulation.state().fabric;
        double sum = 0.0;
        for (std::size_t e = 0; e < fabric.omega.size(); ++e) sum += twistInertia(simulation.fabric(), fabric.absorbed, e) * of(fabric.omega[e]);
        return sum;
    };
    const double momentum = spin([](double omega) { return omega; }), inertia = spin([](double) { return 1.0; });
    for (int n = 1; n <= 5; ++n) simulation.step(n * 1.0e-3);
    EXPECT_GT(spin([](double) { return 1.0; }), 1.2 * inertia) << "it took up water";
    EXPECT_NEAR(spin([](double omega) { return omega; }), momentum, 1.0e-6 * momentum);
}

INSTANTIATE_TEST_SUITE_P(Solvers, WetTwist, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& given) { return given.param == FabricSolver::Grid ? "grid" : "vertex"; });

}  // namespace
}  // namespace sim::test
