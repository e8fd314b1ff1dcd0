#include "sim/surface/liquid_surface.h"
#include "sim/surface/surface_field.h"
#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include <benchmark/benchmark.h>

#include <memory>

using namespace sim;
using namespace sim::test;

// The surface of a splash of 116 k particles, whole and by its parts, beside a step of the simulation that it is of.

namespace {

/// A dam break that has run up the far wall.
Simulation& splash()
{
    static const std::unique_ptr<Simulation> simulation = [] {
        Scene scene = tankScene(kPoly8, 0.3, {80.0, 80.0, 12.0}, {0.0, 0.0, 0.0}, {30.0, 40.0, 12.0});
        scene.sources[0].fill.spacing = 0.5;
        auto made = std::make_unique<Simulation>(scene);
        while (made->state().time < 0.3) made->step(0.3);
        return made;
    }();
    return *simulation;
}

void count(benchmark::State& state)
{
    const auto particles = static_cast<double>(splash().state().liquid.count);
    state.counters["particles"] = particles;
    state.counters["particles/s"] = benchmark::Counter(particles, benchmark::Counter::kIsIterationInvariantRate);
}

void surface(benchmark::State& state)
{
    const LiquidParticles& liquid = splash().state().liquid;
    LiquidSurface made;
    const SurfaceSettings settings{.keepsVolume = state.range(0) >= 1, .hasVelocities = state.range(0) >= 2};
    for (auto _ : state) onThreads(1, [&] { benchmark::DoNotOptimize(&made.find(liquid, 1.0, settings)); });
    count(state);
    state.counters["triangles"] = static_cast<double>(made.mesh().triangles.size());
}

void sortAndField(benchmark::State& state)
{
    const LiquidParticles& liquid = splash().state().liquid;
    BlockGrid grid;
    SurfaceParticles particles;
    BlockArray<float> depth;
    grid.dx = 0.6 * surfaceSpacing(liquid, 1.0);
    for (auto _ : state)
        onThreads(1, [&] {
            sortForSurface(liquid, 1.0, 2.5 / 0.6 + 1.0, grid, particles);
            if (state.range(0) == 1) surfaceField(grid, particles, 2.5f / 0.6f, 1.0f / 0.6f, depth);
        });
    count(state);
}

void simulationStep(benchmark::State& state)
{
    for (auto _ : state) onThreads(1, [&] { benchmark::DoNotOptimize(splash().step(10.0)); });
    count(state);
}

BENCHMARK(sortAndField)->ArgName("field")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(surface)->ArgName("parts")->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK(simulationStep)  // last: it leads the splash on
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5);

}  // namespace

BENCHMARK_MAIN();
