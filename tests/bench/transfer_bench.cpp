#include "sim/transfer/gather.h"
#include "sim/transfer/scatter.h"
#include "sim/transfer/scatter_affine.h"
#include "tests/sim/fixtures.h"

#include <benchmark/benchmark.h>

using namespace sim;
using namespace sim::test;

// P2G, G2P and the sort on the dam-break column, 16 particles per cell, by the number of modes.

namespace {

constexpr std::size_t kParticles = 309600;

SortedLiquid column(int modes) { return randomLiquid(kParticles, modes, {34, 57, 10}, {0, 0, 0}); }

void sort(benchmark::State& state)
{
    SortedLiquid liquid = column(8);
    for (auto _ : state) liquid.sort();
    state.counters["particles/s"] = benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate);
}

void scatter(benchmark::State& state)
{
    const SortedLiquid liquid = column(static_cast<int>(state.range(0)));
    FaceFields faces;
    ScatterScratch scratch;
    for (auto _ : state) particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scratch, faces);
    state.counters["particles/s"] = benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate);
}

void scatterAffine(benchmark::State& state)
{
    const SortedLiquid liquid = column(static_cast<int>(state.range(0)));
    FaceFields faces;
    for (auto _ : state) particlesToFacesAffine({liquid.particles, liquid.order, liquid.grid}, XiMap::AffineConservative, 0.01, faces);
    state.counters["particles/s"] = benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate);
}

void gather(benchmark::State& state)
{
    SortedLiquid liquid = column(static_cast<int>(state.range(0)));
    FaceFields faces;
    fillRandomVelocities(liquid.grid, faces);
    GatherScratch scratch;
    GatherSettings settings;
    settings.modes = static_cast<int>(state.range(0));
    for (auto _ : state) facesToParticles(faces, liquid.order, liquid.grid, settings, scratch, liquid.particles);
    state.counters["particles/s"] = benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate);
}

void transferBoth(benchmark::State& state)
{
    SortedLiquid liquid = column(static_cast<int>(state.range(0)));
    liquid.moveModesHome();
    FaceFields faces;
    fillRandomVelocities(liquid.grid, faces);
    ScatterScratch scatterScratch;
    GatherScratch gatherScratch;
    GatherSettings settings;
    settings.modes = static_cast<int>(state.range(0));
    for (auto _ : state) {
        particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scatterScratch, faces);
        facesToParticles(faces, liquid.order, liquid.grid, settings, gatherScratch, liquid.particles);
    }
    state.counters["particles/s"] = benchmark::Counter(kParticles, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

BENCHMARK(sort)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(scatter)->Arg(1)->Arg(4)->Arg(8)->Arg(11)->Arg(27)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(scatterAffine)->Arg(4)->Arg(8)->Arg(27)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(gather)->Arg(1)->Arg(4)->Arg(8)->Arg(11)->Arg(27)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(transferBoth)->Arg(4)->Arg(8)->Arg(27)->Unit(benchmark::kMillisecond)->UseRealTime();

int main(int argc, char** argv)
{
    benchmark::Initialize(&argc, argv);
    onThreads(1, [] { return benchmark::RunSpecifiedBenchmarks(); });
    return 0;
}
