#include "tests/physics/runs.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

// Counts what the program allocates: operator new, and aligned_alloc, on which AlignedArray stands.

namespace {
std::atomic<long> allocations{0};

void* countedNew(std::size_t bytes)
{
    ++allocations;
    if (void* p = std::malloc(bytes)) return p;
    throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t bytes) { return countedNew(bytes); }
void* operator new[](std::size_t bytes) { return countedNew(bytes); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t bytes)
{
    ++allocations;
    return memalign(alignment, bytes);
}

namespace sim::test {
namespace {

long allocationsOf(Simulation& simulation, int steps)
{
    const long before = allocations;
    for (int step = 0; step < steps; ++step) simulation.step(1.0e9);
    return allocations - before;
}

/// A pool that stirs: its blocks stay the same.
Scene pool(const Transfer& transfer)
{
    Scene scene = tankScene(transfer, 1.0, {20.0, 20.0, 12.0}, {0.0, 0.0, 0.0}, {20.0, 6.0, 12.0});
    scene.settings.time.cfl = 0.5;
    return scene;
}

TEST(Allocation, StepsInTheSameBlocksAllocateNothing)
{
    for (const Transfer& transfer : kTransfers) {
        const long count = onThreads(1, [&] {
            Simulation simulation(pool(transfer));
            allocationsOf(simulation, 10);
            return allocationsOf(simulation, 10);
        });
        EXPECT_EQ(count, 0) << transfer.name;
    }
}

/// A stream through a duct from an inlet to an outlet.
TEST(Allocation, OpeningsAllocateNothing)
{
    for (const Transfer& transfer : kTransfers) {
        Scene scene = tankScene(transfer, 1.0, {40.0, 6.0, 6.0}, {8.0, 0.0, 0.0}, {32.0, 6.0, 6.0});
        scene.settings.time.cfl = 0.5;
        scene.sources[0].emissions[0].velocity = Vec3(20.0, 0.0, 0.0);
        scene.domain = Shape::box({20.0, 3.0, 3.0}, {12.0, 5.0, 5.0});
        scene.openings = {{.name = "inlet", .velocity = 20.0, .where = {}}, {.name = "outlet", .isUpper = true, .level = 9.0, .where = {}}};
        const long count = onThreads(1, [&] {
            Simulation simulation(scene);
            allocationsOf(simulation, 20);
            return allocationsOf(simulation, 20);
        });
        EXPECT_EQ(count, 0) << transfer.name;
    }
}

TEST(Allocation, ViscosityAllocatesNothing)
{
    for (double friction : {0.0, 1.0}) {
        Scene scene = pool(kPoly8);
        scene.settings.liquid.solveViscosity = true;
        scene.settings.liquid.viscosity = 10.0;
        scene.settings.liquid.wallFriction = friction;
        const long count = onThreads(1, [&] {
            Simulation simulation(scene);
            allocationsOf(simulation, 10);
            return allocationsOf(simulation, 10);
        });
        EXPECT_EQ(count, 0) << friction;
    }
}

TEST(Allocation, MovingObstaclesAllocateNothing)
{
    Scene scene = pool(kPoly8);
    Motion motion;
    motion.addOscillation(0.0, 100.0, Vec3::UnitX(), 2.0, 1.0);
    scene.obstacles.push_back(obstacle("ball", Shape::ball({10.0, 4.0, 6.0}, 2.0), motion));
    const long count = onThreads(1, [&] {
        Simulation simulation(scene);
        allocationsOf(simulation, 10);
        // Its waves reach new blocks, in two steps or three; what is kept from step to step is as large in the one after.
        long others = 0;
        int before = 0;
        for (int step = 0; step < 20; ++step) {
            const int blocks = simulation.state().grid.count();
            const long here = allocationsOf(simulation, 1);
            if (simulation.state().grid.count() == blocks && blocks == before) others += here;
            before = blocks;
        }
        return others;
    });
    EXPECT_EQ(count, 0);
}

TEST(Allocation, KeepingTheStateAllocatesNothing)
{
    for (const Transfer& transfer : kTransfers) {
        Scene scene = pool(transfer);
        scene.settings.time.mode = TimeMode::Adaptive;
        const long count = onThreads(1, [&] {
            Simulation simulation(scene);
            allocationsOf(simulation, 10);
            return allocationsOf(simulation, 10);
        });
        EXPECT_EQ(count, 0) << transfer.name;
    }
}

TEST(Allocation, SurfaceTensionAllocatesNothing)
{
    Scene scene = pool(kPoly8);
    scene.settings.liquid.surfaceTensionForce = true;
    const long count = onThreads(1, [&] {
        Simulation simulation(scene);
        allocationsOf(simulation, 10);
        return allocationsOf(simulation, 10);
    });
    EXPECT_EQ(count, 0);
}

TEST(Allocation, CounterSeesWhatArraysAllocate)
{
    const long before = allocations;
    const AlignedArray<double> array(100);
    const std::vector<int> other(100 + array.size());
    EXPECT_EQ(allocations - before, 2);
    EXPECT_EQ(other.size(), 200u);
}

}  // namespace
}  // namespace sim::test
