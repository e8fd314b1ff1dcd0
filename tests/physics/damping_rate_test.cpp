// Damping as a rate: what a factor takes per second is the same for steps of any length.
#include "tests/physics/runs.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

constexpr double kShortest = 0.0625;  ///< CFL number, and in vortexScene() the step in cells per speed

/// How much of the vortex is in the velocities of the particles.
double vortexLeft(const LiquidParticles& liquid)
{
    double product = 0.0, square = 0.0;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 u = vortex(liquid.position(p));
        product += liquid.mass[p] * u.dot(liquid.velocity(p));
        square += liquid.mass[p] * u.squaredNorm();
    }
    return product / square;
}

/// Rate at which the vortex decays over a quarter of its turnover, after two steps: the first scatters modes that no
/// factor has acted on yet [1/s].
double decayRate(const Transfer& transfer, double cfl, TimeIntegrator integrator, double flipRatio, double affineDamping)
{
    constexpr double kEnd = 0.5 * kPi;
    Scene scene = vortexScene(transfer, cfl);
    scene.settings.time.integrator = integrator;
    scene.settings.transfer.flipRatio = flipRatio;
    scene.settings.transfer.affineDamping = affineDamping;
    scene.settings.transfer.dampingDt = kShortest * scene.settings.cell;
    Simulation simulation = moving(scene, vortex);
    const auto leftAt = [&](double time) {
        while (simulation.state().time < time) simulation.step(time);
        return vortexLeft(simulation.state().liquid);
    };
    const double begin = 2.0 * scene.settings.time.dt, start = leftAt(begin);
    return std::log(start / leftAt(begin + kEnd)) / kEnd;
}

/// The extra rate that a factor per shortest step adds changes by at most a tenth over steps eight times as long. A
/// filter takes its part of what each step has gathered anew, which is proportional to the step as long as it is small.
void expectRate(const Transfer& transfer, double factor)
{
    const bool flips = transfer.method == TransferMethod::Flip;
    for (const TimeIntegrator integrator : {TimeIntegrator::Plain, TimeIntegrator::Reflected}) {
        const auto extra = [&](double times) {
            const double cfl = kShortest * times;
            return decayRate(transfer, cfl, integrator, flips ? factor : 1.0, flips ? 0.0 : 1.0 - factor) -
                   decayRate(transfer, cfl, integrator, 1.0, 0.0);
        };
        const double first = extra(1.0);
        EXPECT_GT(first, 0.0);
        std::printf("%s, %s: adds %.3e 1/s", transfer.name.c_str(), integrator == TimeIntegrator::Plain ? "plain" : "reflected", first);
        for (const double times : {2.0, 4.0, 8.0}) {
            const double now = extra(times);
            std::printf(", %+.1f %%", 100.0 * (now / first - 1.0));
            EXPECT_NEAR(now, first, 0.1 * first) << transfer.name << ", steps " << times << " times as long";
        }
        std::printf("\n");
    }
}

TEST(DampingRate, OfFlipDoesNotDependOnTheStep) { expectRate(kFlip, 0.99); }
TEST(DampingRate, OfAffineModesDoesNotDependOnTheStep) { expectRate(kApic, 0.99); }
TEST(DampingRate, OfPolynomialModesDoesNotDependOnTheStep) { expectRate(kPoly8, 0.99); }

}  // namespace
}  // namespace sim::test
