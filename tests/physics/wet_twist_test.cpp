// Water in a yarn turns with it.
#include "sim/fabric/generators.h"
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

INSTANTIATE_TEST_SUITE_P(Solvers, WetTwist, ::testing::Values(FabricSolver::Vertex, FabricSolver::Grid),
                         [](const auto& given) { return given.param == FabricSolver::Grid ? "grid" : "vertex"; });

}  // namespace
}  // namespace sim::test
