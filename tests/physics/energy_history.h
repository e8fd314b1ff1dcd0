#pragma once

#include "sim/core/check.h"
#include "tests/physics/runs.h"

#include <algorithm>
#include <limits>
#include <random>

namespace sim::test {

/// How the energy of a closed scene went, relative to its start.
struct EnergyCourse {
    double end = 1.0;    ///< at the end of the run
    double least = 1.0;  ///< so far
    double rise = 0.0;   ///< the largest one above the least before it
    bool isFinite = true;

    void add(double energy)
    {
        isFinite = isFinite && std::isfinite(energy);
        end = energy;
        least = std::min(least, energy);
        rise = std::max(rise, energy - least);
    }
};

/// Run for `duration` [s], or until the energy has doubled or a step can't be made.
inline EnergyCourse followEnergy(Simulation& simulation, double duration)
{
    EnergyCourse course;
    const double start = simulation.energies().total();
    try {
        while (simulation.state().time < duration && course.isFinite && course.end < 2.0) {
            const StepReport report = simulation.step(duration);
            if (!report.isReflected) course.add(report.energies.total() / start);
        }
    } catch (const RunError&) {
        course.isFinite = false;
    }
    return course;
}

/// Energy that a dam break keeps of its start, on average while its front climbs the far wall: at one time it differs by half a
/// percent between any two runs.
inline double energyKept(const Scene& scene, int samples)
{
    Simulation simulation(scene);
    const double start = simulation.energies().total();
    double sum = 0.0;
    for (int sample = 0; sample < samples; ++sample) {
        const double time = 0.25 + 0.02 * sample;
        StepReport report;
        while (simulation.state().time < time) report = simulation.step(time);
        sum += report.energies.total() / start / samples;
    }
    return sum;
}

/// Kinetic and modal energy of liquid in a half-full tank, on average from 5 s to 10 s, relative to that of the noise of up to 1 cm/s
/// that its particles start with.
inline double noiseAtRest(const Transfer& transfer)
{
    Scene scene = tankScene(transfer, 1.0, {8.0, 16.0, 4.0}, {0.0, 0.0, 0.0}, {8.0, 8.0, 4.0});
    scene.sources[0].fill.spacing = 0.5;
    scene.settings.time.mode = TimeMode::Fixed;
    scene.settings.time.dt = 0.01;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-1.0, 1.0);
    State state = Simulation(scene).state();
    for (std::size_t p = 0; p < state.liquid.count; ++p)
        for (int a = 0; a < kAxes; ++a) state.liquid.mode(a, 0)[p] = noise(random);
    Simulation simulation(scene, std::move(state));
    const auto moving = [](const Energies& energies) { return energies.kinetic + energies.modal; };
    const double start = moving(simulation.energies());
    double sum = 0.0;
    int steps = 0;
    try {
        while (simulation.state().time < 10.0) {
            const double now = moving(simulation.step(10.0).energies);
            if (simulation.state().time > 5.0) sum += now, ++steps;
        }
    } catch (const RunError&) {
        return std::numeric_limits<double>::infinity();
    }
    return sum / steps / start;
}

}  // namespace sim::test
