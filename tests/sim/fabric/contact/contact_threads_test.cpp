#include "tests/sim/fabric/contact/contact_scenes.h"
#include "tests/sim/fixtures.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

// Counts what the program allocates: operator new, and aligned_alloc, on which AlignedArray stands.

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t bytes)
{
    ++allocations;
    if (void* p = std::malloc(bytes > 0 ? bytes : 1)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept  // of std::stable_sort's buffer
{
    ++allocations;
    return std::malloc(bytes > 0 ? bytes : 1);
}
void* operator new(std::size_t bytes, std::align_val_t alignment)
{
    ++allocations;
    if (void* p = memalign(static_cast<std::size_t>(alignment), bytes)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t bytes)
{
    ++allocations;
    return memalign(alignment, bytes);
}

namespace sim::test {
namespace {

/// Hits the middle of a sheet to and fro, one period in 8 steps; returns what acted last.
void shake(ContactRun& run, std::vector<Vec3>& u, int steps)
{
    for (int step = 0; step < steps; ++step) {
        run.contact.beginStep(run.x, run.fabric.mass, ContactRun::kStep, ContactRun::kStep);
        StageClock clock(run.step);
        for (std::size_t v = 0; v < u.size(); ++v) {
            const double share = std::exp(-(run.fabric.rest[v] - Vec3(2.0, 0.0, 2.0)).squaredNorm());
            u[v] = Vec3(0.0, (step % 8 < 4 ? -0.1 : 0.1) * share, 0.02 * std::sin(static_cast<double>(v * v % 97)) * share);
        }
        for (int newton = 0; newton < 2; ++newton) {
            const FabricContact::LimitedMoves limited = run.contact.limit(run.x, u, run.report, clock);
            for (std::size_t v = 0; v < u.size(); ++v) run.x[v] += u[v];
            run.contact.moved(limited);
            const ActiveContacts& contacts = run.contact.activeAt(run.x, clock).pairs();
            for (Vec3& w : u) w.setZero();
            for (std::size_t i = 0; i < contacts.size(); ++i)
                for (int a = 0; a < 4; ++a) u[contacts.vertices[i][a]] -= 0.1 * contacts.weights[i][a] / contacts.stiffness[i] * contacts.force[i];
        }
        if (step % 8 == 7) run.x = run.fabric.rest;  // the next period finds what the first did
    }
}

struct Outcome {
    std::vector<Vec3> x, force;
    std::vector<std::array<int, 4>> vertices;
    bool operator==(const Outcome&) const = default;
};

TEST(FabricContactThreads, SameBitsForAnyThreadCount)
{
    ContactScene layers;
    layers.addCloth({0, 0, 0}, {0.13, 0, 0}, {0, 0, 0.12}, 30, 30, 0.05);
    layers.addCloth({0, 0.08, 0}, {0.12, 0, 0}, {0, 0, 0.13}, 30, 30, 0.05);
    layers.addYarn({0.2, 0.15, 1.1}, {3.5, 0.15, 2.0}, 30, 0.03);
    for (const Fabric& fabric : {wovenSheet(32), layers.fabric}) {
        const auto outcomeOn = [&](int threads) {
            return onThreads(threads, [&] {
                ContactRun run(fabric);
                std::vector<Vec3> u(run.x.size());
                shake(run, u, 7);
                const ActiveContacts& contacts = run.active();
                return Outcome{run.x, contacts.force, contacts.vertices};
            });
        };
        const Outcome one = outcomeOn(1);
        EXPECT_GT(one.vertices.size(), 100u);
        for (int threads : {2, 8}) EXPECT_TRUE(one == outcomeOn(threads)) << threads;
    }
}

TEST(FabricContactThreads, StepsAllocateNothingOnceBuffersHaveGrown)
{
    const Fabric fabric = wovenSheet(40);
    const long count = onThreads(1, [&] {
        ContactRun run(fabric);
        std::vector<Vec3> u(run.x.size());
        shake(run, u, 16);
        const long before = allocations;
        shake(run, u, 16);
        return allocations - before;
    });
    EXPECT_EQ(count, 0);
}

TEST(FabricContactThreads, CounterSeesAllocations)
{
    const long before = allocations;
    const AlignedArray<double> array(100);
    const std::vector<int> other(100 + array.size());
    EXPECT_EQ(allocations - before, 2);
    EXPECT_EQ(other.size(), 200u);
}

}  // namespace
}  // namespace sim::test
