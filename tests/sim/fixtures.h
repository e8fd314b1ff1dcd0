#pragma once

#include "sim/grid/face_fields.h"
#include "sim/particles/liquid_particles.h"
#include "sim/particles/particle_order.h"
#include "sim/particles/velocity_modes.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include "sim/core/parallel.h"

#include <random>

namespace sim::test {

/// Liquid in blocks, sorted and ready to be transferred.
struct SortedLiquid {
    BlockGrid grid;
    LiquidParticles particles;
    ParticleOrder order;
    Ledger ledger;

    void sort() { sortParticles(particles, grid, nullptr, order, &ledger); }

    /// Where the modes of particle s stand now that P2G has been done: put them into its own row, as G2P would.
    void moveModesHome()
    {
        for (int a = 0; a < kAxes; ++a)
            for (int r = 0; r < particles.modeCount; ++r) {
                std::vector<double> sorted(particles.count);
                for (std::size_t s = 0; s < particles.count; ++s) sorted[s] = particles.mode(a, r)[order.source[s]];
                std::copy(sorted.begin(), sorted.end(), particles.mode(a, r));
            }
        for (std::size_t s = 0; s < particles.count; ++s) order.source[s] = static_cast<int>(s);
    }
};

/// `count` particles at random places of a box of `cells` cells that starts at cell `corner`, with random masses and modes of up to 1.
inline SortedLiquid randomLiquid(std::size_t count, int modes, const Vec3i& cells = {21, 13, 10}, const Vec3i& corner = {-9, -3, 2},
                                 double dx = 0.288, unsigned seed = 1)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    SortedLiquid liquid;
    liquid.grid.dx = dx;
    liquid.grid.origin = Vec3(0.1, -0.2, 0.3);
    liquid.particles.modeCount = storedModes(modes);
    for (std::size_t p = 0; p < count; ++p) {
        Vec3 x;
        for (int a = 0; a < kAxes; ++a) x[a] = liquid.grid.origin[a] + dx * (corner[a] + cells[a] * unit(random));
        liquid.particles.add(x, 0.5 + unit(random), static_cast<std::uint32_t>(p), Vec3::Zero());
        for (int a = 0; a < kAxes; ++a)
            for (int r = 0; r < std::min(modes, liquid.particles.modeCount); ++r) liquid.particles.mode(a, r)[p] = 2.0 * unit(random) - 1.0;
    }
    liquid.sort();
    return liquid;
}

/// Random velocities on all faces of all blocks, all of them valid.
inline void fillRandomVelocities(const BlockGrid& grid, FaceFields& faces, unsigned seed = 2)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    faces.velocity.resize(grid.count());
    faces.valid.resize(grid.count());
    for (int b = 0; b < grid.count(); ++b)
        for (int a = 0; a < kAxes; ++a)
            for (int c = 0; c < kBlockCells; ++c) {
                faces.velocity.block(b, a)[c] = unit(random);
                faces.valid.set(b, c, a);
            }
}

/// Run f on `threads` workers, also where that is more than there are cores: TBB needs both the limit and the arena.
template <class F>
auto onThreads(int threads, F&& f)
{
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    return arena.execute(f);
}

}  // namespace sim::test
