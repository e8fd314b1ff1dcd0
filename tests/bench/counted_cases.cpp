// Kernels and short scenes whose instructions, allocations and memory are counted (tests/README.md, Counts):
//   counted_cases         names of all cases, one a line
//   counted_cases CASE    runs it; one line "points,allocations,bytes" comes out
// Instructions are those that callgrind sees between the two requests in `counted`; without valgrind these do nothing.

#include "sim/scene/load_scene.h"
#include "sim/simulation.h"
#include "sim/transfer/gather.h"
#include "sim/transfer/scatter.h"
#include "sim/transfer/scatter_affine.h"
#include "tests/sim/fixtures.h"

#include <malloc.h>

#include <valgrind/callgrind.h>
#include <cstdio>
#include <cstdlib>
#include <functional>

// What everything allocates, libraries included, and what arrays map from the system passes here on its way there.

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* p, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* p);
}

namespace {

// Cases run on one thread.
long allocations = 0;
std::size_t heldBytes = 0, mostBytes = 0;

void hold(std::size_t bytes)
{
    ++allocations;
    heldBytes += bytes;
    mostBytes = std::max(mostBytes, heldBytes);
}

void* counted(void* p)
{
    hold(malloc_usable_size(p));
    return p;
}

}  // namespace

extern "C" {
void* malloc(std::size_t bytes) { return counted(__libc_malloc(bytes)); }
void* calloc(std::size_t count, std::size_t bytes) { return counted(__libc_calloc(count, bytes)); }
void* aligned_alloc(std::size_t alignment, std::size_t bytes) { return counted(__libc_memalign(alignment, bytes)); }
void* realloc(void* p, std::size_t bytes)
{
    heldBytes -= malloc_usable_size(p);
    return counted(__libc_realloc(p, bytes));
}
void free(void* p)
{
    heldBytes -= malloc_usable_size(p);
    __libc_free(p);
}
void* mmap(void* address, std::size_t bytes, int protection, int flags, int file, off_t offset) noexcept
{
    hold(bytes);
    return reinterpret_cast<void*>(syscall(SYS_mmap, address, bytes, protection, flags, file, offset));
}
int munmap(void* address, std::size_t bytes) noexcept
{
    heldBytes -= bytes;
    return static_cast<int>(syscall(SYS_munmap, address, bytes));
}
}

namespace {

using namespace sim;
using namespace sim::test;

struct Counts {
    std::size_t points = 0;  ///< particles of liquid and vertices of fabric
    long allocations = 0;    ///< in what is counted
    std::size_t bytes = 0;   ///< held at most while that runs [B]
};

/// What `work` counts to. It has been run before, so that buffers are there.
template <class Work>
Counts count(std::size_t points, Work&& work)
{
    const long before = allocations;
    mostBytes = heldBytes;
    CALLGRIND_START_INSTRUMENTATION;
    work();
    CALLGRIND_STOP_INSTRUMENTATION;
    return {points, allocations - before, mostBytes};
}

template <class Work>
Counts countAgain(std::size_t points, Work&& work)
{
    work();
    return count(points, work);
}

/// The dam-break column with its 16 particles per cell, a fifteenth of it.
SortedLiquid column(int modes) { return randomLiquid(20480, modes, {16, 16, 5}, {0, 0, 0}); }

Counts sortColumn()
{
    SortedLiquid liquid = column(8);
    return countAgain(liquid.particles.count, [&] { liquid.sort(); });
}

Counts scatter(int modes)
{
    const SortedLiquid liquid = column(modes);
    FaceFields faces;
    ScatterScratch scratch;
    return countAgain(liquid.particles.count, [&] { particlesToFaces({liquid.particles, liquid.order, liquid.grid}, scratch, faces); });
}

Counts scatterAffine(int modes)
{
    const SortedLiquid liquid = column(modes);
    FaceFields faces;
    return countAgain(liquid.particles.count, [&] {
        particlesToFacesAffine({liquid.particles, liquid.order, liquid.grid}, XiMap::AffineConservative, 0.01, faces);
    });
}

Counts gather(int modes)
{
    SortedLiquid liquid = column(modes);
    FaceFields faces;
    fillRandomVelocities(liquid.grid, faces);
    GatherScratch scratch;
    GatherSettings settings;
    settings.modes = modes;
    return countAgain(liquid.particles.count, [&] { facesToParticles(faces, liquid.order, liquid.grid, settings, scratch, liquid.particles); });
}

/// `steps` steps of a scene, after `before` others.
Counts sceneSteps(const char* scene, int before, int steps, std::vector<std::string> set)
{
    LoadOptions options;
    options.set = std::move(set);
    Simulation simulation(loadScene(std::filesystem::path(SCENES_DIR) / scene, options));
    const auto advance = [&](int n) {
        while (n-- > 0) simulation.step(1.0e9);
    };
    advance(before);
    return count(simulation.state().liquid.count + simulation.fabric().vertexCount(), [&] { advance(steps); });
}

/// The ball of a splash above the middle of the sheet, which it meets in the steps before.
std::vector<std::string> fallingBall(const std::string& middle)
{
    return {"liquid.sources.ball.shape={ball: {center: [" + middle + ", 1.6, " + middle + "], radius: 1.44}}",
            "liquid.sources.ball.velocity=[0, -50, 0]"};
}

struct Case {
    const char* name;
    std::function<Counts()> run;
};

const Case kCases[] = {
    {"sort", sortColumn},
    {"scatter 1", [] { return scatter(1); }},
    {"scatter 4", [] { return scatter(4); }},
    {"scatter 8", [] { return scatter(8); }},
    {"scatter 27", [] { return scatter(27); }},
    {"affine scatter 8", [] { return scatterAffine(8); }},
    {"gather 1", [] { return gather(1); }},
    {"gather 4", [] { return gather(4); }},
    {"gather 8", [] { return gather(8); }},
    {"gather 27", [] { return gather(27); }},
    {"dam break",
     [] {
         return sceneSteps("dam_break_small.yaml", 5, 5, {"grid.cell=0.576", "time.dt=1e-3"});
     }},
    {"drop", [] { return sceneSteps("drop.yaml", 30, 5, {}); }},
    {"splash on cloth", [] { return sceneSteps("splash_cloth_small.yaml", 5, 3, fallingBall("7.2")); }},
    {"splash on yarns", [] { return sceneSteps("splash_yarn_small.yaml", 5, 3, fallingBall("7.128")); }},
    {"wicking strip", [] { return sceneSteps("wicking_strip.yaml", 5, 5, {}); }},
};

}  // namespace

int main(int argc, char** argv)
{
    for (const Case& one : kCases) {
        if (argc < 2) std::puts(one.name);
        if (argc < 2 || argv[1] != std::string(one.name)) continue;
        const std::size_t atStart = heldBytes;
        const Counts counts = onThreads(1, one.run);
        std::printf("%zu,%ld,%zu\n", counts.points, counts.allocations, counts.bytes - atStart);
    }
    return 0;
}
