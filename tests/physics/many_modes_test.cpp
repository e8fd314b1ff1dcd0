// More modes than 8 keep still liquid still and gain no energy in a dam break (transfer/README.md, More than 8 modes).
#include "tests/physics/energy_history.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

Transfer polyPic(int modes) { return {"PolyPIC-" + std::to_string(modes), TransferMethod::PolyPic, modes}; }

/// From 12 on, 27 modes are stored and the rest of those gathered are left out.
TEST(ManyModes, GainNoEnergyInALongDamBreak)
{
    for (const int modes : {11, 12, 15, 20, 27}) {
        Scene scene = coarseDamBreak(polyPic(modes));
        scene.settings.time.cfl = 1.0;
        Simulation simulation(scene);
        const EnergyCourse course = followEnergy(simulation, 5.0);
        std::printf("%d modes: energy %.4f after %.1f s, risen by up to %.4f\n", modes, course.end, simulation.state().time, course.rise);
        EXPECT_TRUE(course.isFinite) << modes;
        EXPECT_LT(course.rise, 0.02) << modes;  // the volume's correction lifts what lies too low
        EXPECT_LT(course.end, 0.6) << modes;
    }
}

/// Eight modes reach 13 times the energy of the noise, more modes 25 to 28 times; where particles at the surface gather
/// all modes, 11 of them reach 99 times and 27 reach 188 times.
TEST(ManyModes, LeaveStillLiquidStill)
{
    for (const auto& [modes, limit] : {std::pair(11, 50.0), std::pair(27, 70.0)}) {
        const double growth = noiseAtRest(polyPic(modes));
        std::printf("%d modes: the noise at rest has %.1f times its energy later\n", modes, growth);
        EXPECT_LT(growth, limit) << modes;
    }
}

}  // namespace
}  // namespace sim::test
