#include "tests/sim/solvers/poisson_scenes.h"

#include <benchmark/benchmark.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>
#include <string>

// Cold: from p = 0. Warm: from the solution for a right-hand side that differs by 1 %. Both to 1e-6, set-up included.
// Last argument: threads. Look at the median over repetitions (--benchmark_repetitions) beside the process's CPU time.

namespace sim::test {
namespace {

struct Size {
    std::string name;
    PoissonScene (*make)();
};
const std::array<Size, 5> kSizes = {{{"column20k",
                                      [] {
                                          return boxWithSurface({34, 64, 10});
                                      }},
                                     {"pool87k", [] { return poolWithWaves(); }},
                                     {"surface64",
                                      [] {
                                          return boxWithSurface({64, 64, 64});
                                      }},
                                     {"full64",
                                      [] {
                                          return fullBox({64, 64, 64});
                                      }},
                                     {"surface128", [] {
                                          return boxWithSurface({128, 128, 128});
                                      }}}};

/// The scene of the last benchmark: those of one size follow each other.
struct Prepared {
    std::string name;
    PoissonScene scene;
    BlockArray<double> zero, solution, changedRhs;
    PoissonSolver solver;

    explicit Prepared(const Size& size) : name(size.name), scene(size.make())
    {
        zero.resize(scene.grid.count());
        solution = zero;
        solver.solve(scene.grid, scene.matrix, scene.rhs, 1.0e-6, 200, solution);
        changedRhs = scene.rhs;
        scene.forEachCell([&](const Vec3i& cell, int b, int c) {
            changedRhs.block(b)[c] *= 1.0 + 0.01 * std::sin(0.1 * cell.x() + 0.2 * cell.y() + 0.15 * cell.z());
        });
    }
};

enum class What { Cold, Warm, SetUp };

void measure(benchmark::State& state, const Size& size, What what, std::optional<Prepared>& prepared)
{
    if (!prepared || prepared->name != size.name) prepared.emplace(size);
    Prepared& p = *prepared;
    const int threads = static_cast<int>(state.range(0));
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([&] {
        BlockArray<double> x;
        SolveReport report;
        for (auto _ : state) {
            if (what == What::SetUp) {
                p.solver.multigrid().build(p.scene.grid, p.scene.matrix);
                continue;
            }
            state.PauseTiming();
            x = what == What::Cold ? p.zero : p.solution;
            state.ResumeTiming();
            report = p.solver.solve(p.scene.grid, p.scene.matrix, what == What::Cold ? p.scene.rhs : p.changedRhs, 1.0e-6, 200, x);
        }
        state.counters["iterations"] = report.iterations;
        state.counters["cells"] = p.scene.cells;
    });
}

}  // namespace
}  // namespace sim::test

int main(int argc, char** argv)
{
    using namespace sim::test;
    std::optional<Prepared> prepared;
    for (const Size& size : kSizes)
        for (const auto& [what, name] : {std::pair(What::Cold, "cold"), {What::Warm, "warm"}, {What::SetUp, "setup"}})
            benchmark::RegisterBenchmark((size.name + "/" + name).c_str(),
                                         [&, what = what](benchmark::State& state) { measure(state, size, what, prepared); })
                ->Arg(1)
                ->Arg(2)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime()
                ->MeasureProcessCPUTime();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
