// How numbers of modes trade noise against what they keep of a flow:
//   mode_stability MODES ...
// One line of a table per number of modes; its head with no argument. results/mode_stability.md says what came out.

#include "tests/physics/energy_history.h"
#include "tests/physics/vortex_run.h"
#include "tests/sim/transfer/transfers.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <limits>

namespace {

using namespace sim;
using namespace sim::test;

Transfer transferOf(int modes) { return modes == 4 ? kApic : Transfer{fmt::format("PolyPIC-{}", modes), TransferMethod::PolyPic, modes}; }

/// 12³ cells of particles at random places, 8 per cell.
Transfers block(int modes) { return Transfers(randomLiquid(12 * 12 * 12 * 8, modes, {12, 12, 12}, {0, 0, 0})); }

/// Energy that random velocities of the faces still have after G2P and P2G with nothing moved, relative.
double noiseKept(int modes)
{
    Transfers transfers = block(modes);
    transfers.toFaces();
    fillRandomVelocities(transfers.grid(), transfers.faces);
    const double before = transfers.faceEnergy();
    transfers.toParticles(modes);
    transfers.liquid.sort();
    transfers.toFaces();
    return transfers.faceEnergy() / before;
}

/// Of one G2P of that block [ms], the least of many.
double gatherTime(int modes)
{
    Transfers transfers = block(modes);
    fillRandomVelocities(transfers.grid(), transfers.faces);
    double least = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 40; ++repeat) {
        const auto start = std::chrono::steady_clock::now();
        transfers.toParticles(modes);
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        least = std::min(least, taken.count());
    }
    return least;
}

EnergyCourse damBreak(int modes, TimeMode mode, double cfl, double duration)
{
    Scene scene = coarseDamBreak(transferOf(modes));
    scene.settings.time.mode = mode;
    scene.settings.time.cfl = cfl;
    const double fastest = std::sqrt(2.0 * kEarthGravity * 12.0);  // of what falls from the top of the column [cm/s]
    if (mode == TimeMode::Fixed) scene.settings.time.dt = cfl * scene.settings.cell / fastest;
    Simulation simulation(scene);
    return followEnergy(simulation, duration);
}

/// The longest steps, in cells that what falls from the top crosses, with which the dam break gains nothing in 3 s.
double largestStep(int modes)
{
    double largest = 0.0;
    for (const double cfl : {1.0, 2.0, 4.0, 8.0, 16.0}) {
        const EnergyCourse course = damBreak(modes, TimeMode::Fixed, cfl, 3.0);
        if (!course.isFinite || course.rise > 0.02) break;
        largest = cfl;
    }
    return largest;
}

/// Energy that the reflected dam break has on average from 0.25 s to 0.55 s, relative to its start: at one time it
/// differs between any two runs.
double damBreakKeeps(int modes)
{
    Scene scene = coarseDamBreak(transferOf(modes));
    scene.settings.time.cfl = 0.25;
    scene.settings.time.integrator = TimeIntegrator::Reflected;
    return energyKept(scene, 16);
}

void printNumbers(std::initializer_list<double> numbers)
{
    for (const double number : numbers) fmt::print(",{:.4g}", number);
    std::fflush(stdout);
}

void measure(int modes)
{
    const auto turn = [&](TimeIntegrator integrator) { return turnVortex(gathered(vortexScene(transferOf(modes), 0.25, integrator), vortex)); };
    const VortexEnd plain = turn(TimeIntegrator::Plain), reflected = turn(TimeIntegrator::Reflected);
    fmt::print("{}", modes);
    printNumbers({noiseKept(modes), 1.0 - plain.kept, plain.error, 1.0 - reflected.kept, reflected.error});
    const EnergyCourse coarse = damBreak(modes, TimeMode::Cfl, 1.0, 12.0);
    printNumbers({coarse.end, coarse.rise, noiseAtRest(transferOf(modes)), largestStep(modes)});
    const EnergyCourse fine = damBreak(modes, TimeMode::Cfl, 0.25, 3.0);
    printNumbers({damBreakKeeps(modes), fine.end, fine.rise, gatherTime(modes)});
    fmt::print("\n");
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc == 1)
        fmt::print(
            "modes,noise_kept,vortex_loss,vortex_error,vortex_loss_reflected,vortex_error_reflected,"
            "dam_energy_12s_cfl1,dam_rise_cfl1,noise_at_rest,largest_step_cfl,dam_kept_reflected,"
            "dam_energy_3s_cfl025,dam_rise_cfl025,gather_ms\n");
    onThreads(1, [&] {
        for (int n = 1; n < argc; ++n) measure(std::atoi(argv[n]));
    });
    return 0;
}
