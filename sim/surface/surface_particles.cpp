#include "sim/surface/surface_particles.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr std::size_t kParticlesPerTask = 4096;

Vec3i stepTo(int neighbour) { return {neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1}; }

void sortAndUnite(std::vector<Vec3i>& coords)
{
    const auto isBefore = [](const Vec3i& a, const Vec3i& b) {
        return a.z() != b.z() ? a.z() < b.z() : a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
    };
    std::sort(coords.begin(), coords.end(), isBefore);
    coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
}

void findPlaces(const LiquidParticles& liquid, const BlockGrid& grid, SurfaceParticles& out)
{
    out.blockOf.resize(liquid.count);
    out.inside.resize(liquid.count);
    parallelFor(liquid.count, kParticlesPerTask, [&](std::size_t p) {
        const Vec3 inCells = (liquid.position(p) - grid.origin) / grid.dx, inBlocks = (inCells / kBlockEdge).array().floor();
        if (!(inBlocks.cwiseAbs().maxCoeff() < BlockGrid::kMaxCoordinate - 2))
            throw RunError("surface: a particle is too far away from the origin for its grid");
        out.blockOf[p] = inBlocks.cast<int>();
        out.inside[p] = (inCells - kBlockEdge * inBlocks).cast<float>();
    });
}

/// body(particle, block number) for all that have mass, one after the other. The simulation keeps particles of one
/// place together: most are in the block of the one before.
template <class Body>
void forEachInItsBlock(const LiquidParticles& liquid, const BlockGrid& grid, const SurfaceParticles& particles, Body&& body)
{
    int block = BlockGrid::kNone;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        if (!(liquid.mass[p] > 0.0)) continue;
        if (block == BlockGrid::kNone || grid.coords(block) != particles.blockOf[p]) block = grid.find(particles.blockOf[p]);
        body(p, block);
    }
}

constexpr std::uint32_t kAllAround = (1u << 27) - 1;

/// The blocks around one that lie within `reach` of a place in it, as bits of neighbourIndex.
std::uint32_t blocksInReach(const Eigen::Vector3f& x, float reach)
{
    std::uint32_t bits = 0;
    for (int n = 0; n < 27; ++n) {
        const Vec3i step = stepTo(n);
        bool isNear = true;
        for (int a = 0; a < kAxes; ++a) isNear = isNear && (step[a] == 0 || (step[a] < 0 ? x[a] < reach : x[a] > kBlockEdge - reach));
        bits |= isNear ? 1u << n : 0u;
    }
    return bits;
}

/// First the blocks that hold particles, then those around them as well.
void fitBlocks(const LiquidParticles& liquid, float reach, BlockGrid& grid, SurfaceParticles& work)
{
    work.coords.clear();
    for (std::size_t p = 0; p < liquid.count; ++p)
        if (liquid.mass[p] > 0.0 && (work.coords.empty() || work.coords.back() != work.blockOf[p])) work.coords.push_back(work.blockOf[p]);
    sortAndUnite(work.coords);
    grid.setBlocks(work.coords);

    work.reached.assign(grid.count(), 0);
    forEachInItsBlock(liquid, grid, work, [&](std::size_t p, int block) {
        if (work.reached[block] != kAllAround) work.reached[block] |= blocksInReach(work.inside[p], reach);
    });
    work.missing.clear();
    for (int b = 0; b < grid.count(); ++b)
        for (int n = 0; n < 27; ++n)
            if ((work.reached[b] >> n & 1) != 0 && grid.neighbours(b)[n] == grid.count()) work.missing.push_back(grid.coords(b) + stepTo(n));
    sortAndUnite(work.missing);
    work.coords.insert(work.coords.end(), work.missing.begin(), work.missing.end());
    grid.setBlocks(work.coords);
}

/// Counting sort: particles of one bin stay in their order.
void findSlots(const LiquidParticles& liquid, const BlockGrid& grid, SurfaceParticles& work)
{
    work.binOf.resize(liquid.count);
    work.slot.assign(liquid.count, -1);
    work.binStart.assign(SurfaceParticles::kBins * grid.count() + 1, 0);
    forEachInItsBlock(liquid, grid, work, [&](std::size_t p, int block) {
        const Vec3i b = (work.inside[p] / SurfaceParticles::kBinEdge).cast<int>().cwiseMin(1);
        work.binOf[p] = SurfaceParticles::kBins * block + 4 * b.z() + 2 * b.y() + b.x();
        ++work.binStart[work.binOf[p] + 1];
    });
    for (std::size_t b = 1; b < work.binStart.size(); ++b) work.binStart[b] += work.binStart[b - 1];
    work.next.assign(work.binStart.begin(), work.binStart.end() - 1);
    for (std::size_t p = 0; p < liquid.count; ++p)
        if (liquid.mass[p] > 0.0) work.slot[p] = work.next[work.binOf[p]]++;
}

}  // namespace

double surfaceSpacing(const LiquidParticles& liquid, double density)
{
    const double sum = parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p]; }),
                 squares = parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p] * liquid.mass[p]; });
    return sum > 0.0 ? std::cbrt(squares / sum / density) : 0.0;
}

void sortForSurface(const LiquidParticles& liquid, double density, double reach, BlockGrid& grid, SurfaceParticles& particles)
{
    SIM_CHECK(reach <= kBlockEdge);
    findPlaces(liquid, grid, particles);
    fitBlocks(liquid, static_cast<float>(reach), grid, particles);
    findSlots(liquid, grid, particles);

    const std::size_t padded = liquid.count + kFloatLanes;  // packs are loaded whole
    for (int a = 0; a < kAxes; ++a) particles.x[a].resize(padded), particles.velocity[a].resize(padded);
    particles.radius.resize(padded);
    parallelFor(liquid.count, kParticlesPerTask, [&](std::size_t p) {
        const int s = particles.slot[p];
        if (s < 0) return;
        const Vec3 v = liquid.velocity(p);
        for (int a = 0; a < kAxes; ++a) {
            particles.x[a][s] = particles.inside[p][a];
            particles.velocity[a][s] = static_cast<float>(v[a]);
        }
        particles.radius[s] = static_cast<float>(std::cbrt(0.75 / kPi * liquid.mass[p] / density) / grid.dx);
    });
    particles.volume = parallelSum(liquid.count, [&](std::size_t p) { return std::max(liquid.mass[p], 0.0); }) / density;
}

}  // namespace sim
