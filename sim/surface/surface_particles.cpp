#include "sim/surface/surface_particles.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr std::size_t kGrain = 4096;

bool isBefore(const Vec3i& a, const Vec3i& b)
{
    return std::lexicographical_compare(a.data(), a.data() + kAxes, b.data(), b.data() + kAxes);
}

void sortAndUnite(std::vector<Vec3i>& coords)
{
    std::sort(coords.begin(), coords.end(), isBefore);
    coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
}

/// Place of a particle: coordinates of its block, and the position in it [cells].
struct Place {
    Vec3i block;
    Eigen::Vector3f inside;

    Place(const BlockGrid& grid, const Vec3& x)
    {
        const Vec3 inCells = (x - grid.origin) / grid.dx, inBlocks = (inCells / kBlockEdge).array().floor();
        if (!(inBlocks.cwiseAbs().maxCoeff() < BlockGrid::kMaxCoordinate - 2))
            throw RunError("surface: a particle is too far away from the origin for its grid");
        block = inBlocks.cast<int>();
        inside = (inCells - kBlockEdge * inBlocks).cast<float>();
    }
    int bin() const
    {
        const Eigen::Vector3i b = (inside / SurfaceParticles::kBinEdge).cast<int>().cwiseMin(1);
        return b.x() + 2 * b.y() + 4 * b.z();
    }
};

/// The blocks around one that lie within `reach` of a place in it, as bits of neighbourIndex.
std::uint32_t blocksInReach(const Eigen::Vector3f& x, float reach)
{
    std::uint32_t bits = 0;
    for (int n = 0; n < 27; ++n) {
        const Vec3i step(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        bool isNear = true;
        for (int a = 0; a < kAxes; ++a)
            isNear = isNear && (step[a] == 0 || (step[a] < 0 ? x[a] < reach : x[a] > kBlockEdge - reach));
        bits |= isNear ? 1u << n : 0u;
    }
    return bits;
}

}  // namespace

double surfaceSpacing(const LiquidParticles& liquid, double density)
{
    const double sum = parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p]; }),
                 squares = parallelSum(liquid.count, [&](std::size_t p) { return liquid.mass[p] * liquid.mass[p]; });
    return sum > 0.0 ? std::cbrt(squares / sum / density) : 0.0;
}

void sortForSurface(const LiquidParticles& liquid, double density, double reach, BlockGrid& grid, SurfaceParticles& out)
{
    // Blocks with particles, from runs of particles of one block: the simulation keeps neighbours together.
    out.coords.clear();
    for (std::size_t p = 0; p < liquid.count; ++p) {
        if (!(liquid.mass[p] > 0.0)) continue;
        const Vec3i block = Place(grid, liquid.position(p)).block;
        if (out.coords.empty() || out.coords.back() != block) out.coords.push_back(block);
    }
    sortAndUnite(out.coords);
    grid.setBlocks(out.coords);

    // And those around them that something reaches.
    out.touched.assign(grid.count(), 0);
    Vec3i last = Vec3i::Zero();
    int block = BlockGrid::kNone;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        if (!(liquid.mass[p] > 0.0)) continue;
        const Place place(grid, liquid.position(p));
        if (block == BlockGrid::kNone || place.block != last) block = grid.find(place.block), last = place.block;
        out.touched[block] |= blocksInReach(place.inside, static_cast<float>(reach));
    }
    out.missing.clear();
    for (int b = 0; b < grid.count(); ++b)
        for (int n = 0; n < 27; ++n)
            if ((out.touched[b] >> n & 1) != 0 && grid.neighbours(b)[n] == grid.count())
                out.missing.push_back(grid.coords(b) + Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
    sortAndUnite(out.missing);
    out.coords.insert(out.coords.end(), out.missing.begin(), out.missing.end());
    grid.setBlocks(out.coords);

    // Counting sort by bin; particles of one bin stay in their order.
    out.binOf.resize(liquid.count);
    out.binStart.assign(SurfaceParticles::kBins * grid.count() + 1, 0);
    block = BlockGrid::kNone;
    for (std::size_t p = 0; p < liquid.count; ++p) {
        out.binOf[p] = BlockGrid::kNone;
        if (!(liquid.mass[p] > 0.0)) continue;
        const Place place(grid, liquid.position(p));
        if (block == BlockGrid::kNone || place.block != last) block = grid.find(place.block), last = place.block;
        out.binOf[p] = SurfaceParticles::kBins * block + place.bin();
        ++out.binStart[out.binOf[p] + 1];
    }
    for (std::size_t b = 1; b < out.binStart.size(); ++b) out.binStart[b] += out.binStart[b - 1];
    const std::size_t padded = liquid.count + kFloatLanes;
    for (int a = 0; a < kAxes; ++a) out.x[a].resize(padded), out.velocity[a].resize(padded);
    out.radius.resize(padded);
    std::vector<int> next(out.binStart.begin(), out.binStart.end() - 1);
    for (std::size_t p = 0; p < liquid.count; ++p) {
        if (out.binOf[p] == BlockGrid::kNone) continue;
        const int s = next[out.binOf[p]]++;
        const Place place(grid, liquid.position(p));
        const Vec3 v = liquid.velocity(p);
        for (int a = 0; a < kAxes; ++a) {
            out.x[a][s] = place.inside[a];
            out.velocity[a][s] = static_cast<float>(v[a]);
        }
        out.radius[s] = static_cast<float>(std::cbrt(0.75 / kPi * liquid.mass[p] / density) / grid.dx);
    }
    out.volume = parallelSum(liquid.count, [&](std::size_t p) { return std::max(liquid.mass[p], 0.0); }) / density;
}

}  // namespace sim
