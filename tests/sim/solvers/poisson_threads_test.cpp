#include "tests/sim/solvers/poisson_laws.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <new>
#include <thread>

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t n)
{
    allocations.fetch_add(1);
    if (void* p = std::malloc(n > 0 ? n : 1)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace sim::test {
namespace {

/// How many threads really work here: tasks wait until that many have met, or some time has passed.
int workersSeen(int threads)
{
    std::atomic<int> met{0};
    tbb::parallel_for(
        0, threads,
        [&](int) {
            met.fetch_add(1);
            for (int wait = 0; wait < 2000 && met.load() < threads; ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        },
        tbb::simple_partitioner());
    return met.load();
}

BlockArray<double> solveOn(int threads, const PoissonScene& scene)
{
    BlockArray<double> p = zeroPressure(scene);
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute([&] {
        EXPECT_EQ(workersSeen(threads), threads);
        EXPECT_TRUE(PoissonSolver().solve(scene.grid, scene.matrix, scene.rhs, 1.0e-8, 200, p).converged);
    });
    return p;
}

TEST(Poisson, SameBitsForAnyThreadCount)
{
    for (const PoissonScene& scene : {poolWithWaves(), fullBox({50, 40, 44})}) {
        const BlockArray<double> one = solveOn(1, scene);
        for (int threads : {2, 8}) EXPECT_TRUE(sameBits(one, solveOn(threads, scene))) << threads;
    }
}

TEST(Poisson, AllocatesNothingOnceItHasGrown)
{
    const PoissonScene large = poolWithWaves(), small = fullBox({40, 40, 40});
    PoissonSolver solver;
    BlockArray<double> p, q;
    const auto solveBoth = [&] {
        for (int n = 0; n < 2; ++n) {
            solver.solve(large.grid, large.matrix, large.rhs, 1.0e-6, 200, p);
            solver.solve(small.grid, small.matrix, small.rhs, 1.0e-6, 200, q);
        }
    };
    solveBoth();
    const long before = allocations.load();
    solveBoth();
    EXPECT_GT(before, 0);
    EXPECT_EQ(allocations.load(), before);
}

}  // namespace
}  // namespace sim::test
