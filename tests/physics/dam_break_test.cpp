#include "tests/physics/energy_history.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

/// Martin & Moyce 1952, Table 2, n² = 2: time T = t √(2g/a), front Z = x/a.
constexpr std::array<std::array<double, 2>, 15> kMartinMoyce = {{{0.41, 1.11},
                                                                 {0.84, 1.22},
                                                                 {1.19, 1.44},
                                                                 {1.43, 1.67},
                                                                 {1.63, 1.89},
                                                                 {1.83, 2.11},
                                                                 {1.98, 2.33},
                                                                 {2.20, 2.56},
                                                                 {2.32, 2.78},
                                                                 {2.51, 3.00},
                                                                 {2.65, 3.22},
                                                                 {2.83, 3.44},
                                                                 {2.98, 3.67},
                                                                 {3.11, 3.89},
                                                                 {3.33, 4.11}}};
constexpr double kGateRelease = 0.175;

double experiment(double time)
{
    for (std::size_t n = 1; n < kMartinMoyce.size(); ++n) {
        const auto &from = kMartinMoyce[n - 1], &to = kMartinMoyce[n];
        if (time <= to[0]) return from[1] + (to[1] - from[1]) * (time - from[0]) / (to[0] - from[0]);
    }
    return std::nan("");
}

/// Largest x [cells] of the liquid cells of the lowest layer that hang together with the bulk, in any slice.
int frontCell(const Simulation& simulation, int depth)
{
    int front = 0;
    for (int z = 0; z < depth; ++z) {
        int x = 0;
        while (isLiquid(simulation, {x, 0, z})) ++x;
        front = std::max(front, x);
    }
    return front;
}

void followTheExperiment(const Transfer& transfer)
{
    constexpr int kCells = 32, kDepth = 4;
    constexpr double kWidth = 5.715;  // 2.25 inches [cm]
    Scene scene = tankScene(transfer, kWidth / kCells, {150.0, 80.0, kDepth}, {0.0, 0.0, 0.0}, {kCells, 2 * kCells, kDepth});
    scene.sources[0].fill.spacing = 0.5;
    scene.settings.time.cfl = 0.75;
    Simulation simulation(scene);
    const double second = std::sqrt(2.0 * kEarthGravity / kWidth);
    double worst = 0.0, sum = 0.0;
    int samples = 0;
    for (double time = 0.1; time < 2.5; time += 0.1) {
        while (simulation.state().time < time / second) simulation.step(time / second);
        if (time < 1.0) continue;
        // The middle of the last cell: half a cell from either end of where the surface can be.
        const double front = (frontCell(simulation, kDepth) - 0.5) / kCells, measured = experiment(time + kGateRelease);
        const double error = front / measured - 1.0;
        EXPECT_LT(std::abs(error), 0.1) << "T = " << time << ": x/a = " << front << ", measured " << measured;
        worst = std::max(worst, std::abs(error));
        sum += std::abs(error);
        ++samples;
    }
    ASSERT_GT(samples, 10);
    std::printf("%s: front error mean %.1f %%, largest %.1f %%, %ld steps\n", transfer.name.c_str(), 100.0 * sum / samples, 100.0 * worst,
                static_cast<long>(simulation.state().step));
}

TEST(DamBreak, FrontFollowsMartinAndMoyceWithPolyPic) { followTheExperiment(kPoly8); }
TEST(DamBreak, FrontFollowsMartinAndMoyceWithApic) { followTheExperiment(kApic); }

/// Liquid thrown into the corner under a lid falls down again; right at the lid, it would hang there while its gradients
/// grow by g dt in every step.
TEST(DamBreak, NoLiquidSticksToTheCeiling)
{
    for (const Transfer& transfer : {kApic, kPoly11}) {
        Scene scene = tankScene(transfer, 1.0, {12.0, 12.0, 4.0}, {0.0, 6.0, 0.0}, {4.0, 10.0, 4.0});
        scene.sources[0].emissions[0].velocity = {-50.0, 200.0, 0.0};
        Simulation simulation(scene);
        EnergyCourse course;
        const double start = simulation.energies().total();
        while (simulation.state().time < 4.0) course.add(simulation.step(4.0).energies.total() / start);
        const LiquidParticles& liquid = simulation.state().liquid;
        const double highest = *std::max_element(liquid.x[1].data(), liquid.x[1].data() + liquid.count);
        std::printf("%s: after 4 s none is higher than %.2f cm, energy %.4f, risen by up to %.4f\n", transfer.name.c_str(), highest, course.end,
                    course.rise);
        EXPECT_LT(highest, 6.0) << transfer.name;
        EXPECT_LT(course.rise, 0.02) << transfer.name;
    }
}

}  // namespace
}  // namespace sim::test
