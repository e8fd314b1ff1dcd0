#include "sim/surface/surface_field.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace sim {

namespace {

/// Two rows of 8 nodes side by side in a pack: a block is 8 planes of 4 packs.
constexpr int kPairs = kBlockEdge / 2, kPacks = kBlockEdge * kPairs;
static_assert(kFloatLanes == 2 * kBlockEdge);

constexpr FloatPack kLaneX = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
constexpr FloatPack kLaneY = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};

/// Nodes of a block along one axis that lie within `reach` of a place.
struct Range {
    Range(float place, float reach)
        : low(std::max(0, static_cast<int>(std::ceil(place - reach)))), high(std::min(kBlockEdge - 1, static_cast<int>(std::floor(place + reach))))
    {
    }
    int low, high;
};

/// Sums of weights relative to that amid bulk liquid: up to the first, as between a few drops, the nearest particle
/// tells the distance; from the second on, as at a bulk surface, the mean place does.
constexpr float kSparse = 0.17f, kCrowded = 0.41f;

/// Σ w, Σ w x … over particles at the nodes of one block, w = (1 − q)³ and q = d²/reach², and Σ (1 − q)¹⁶.
struct NodeSums {
    FloatPack weight[kPacks] = {}, x[kPacks] = {}, y[kPacks] = {}, z[kPacks] = {}, radius[kPacks] = {}, sharp[kPacks] = {};

    /// @param at      place of the particle relative to the lower corner of the block [cells]
    /// @param wanted  a bit per pack: the others may stay as they are
    [[gnu::always_inline]] void add(const Eigen::Vector3f& at, float particleRadius, float reach, std::uint32_t wanted)
    {
        // Only rows that the ball of reach may meet within the block.
        constexpr float kLast = kBlockEdge - 1;
        const float offX = std::max({0.0f, -at.x(), at.x() - kLast}), acrossSquared = reach * reach - offX * offX;
        if (!(acrossSquared > 0.0f)) return;
        const float across = std::sqrt(acrossSquared);
        const Range planes(at.z(), across), rows(at.y(), across);
        const float scale = 1.0f / (reach * reach);
        const FloatPack dx = kLaneX - at.x(), restX = 1.0f - scale * (dx * dx);
        for (int k = planes.low; k <= planes.high; ++k) {
            const float dz = static_cast<float>(k) - at.z();
            const FloatPack restXZ = restX - scale * dz * dz;
            for (int j = rows.low / 2; 2 * j <= rows.high; ++j) {
                const int n = kPairs * k + j;
                if ((wanted >> n & 1) == 0) continue;
                const FloatPack dy = kLaneY + (static_cast<float>(2 * j) - at.y());
                FloatPack rest = restXZ - scale * (dy * dy);
                rest = rest > 0.0f ? rest : FloatPack{};
                const FloatPack squared = rest * rest, w = squared * rest;
                FloatPack power = squared * squared;
                power *= power;
                weight[n] += w;
                x[n] += w * at.x();
                y[n] += w * at.y();
                z[n] += w * at.z();
                radius[n] += w * particleRadius;
                sharp[n] += power * power;
            }
        }
    }

    /// Reach − φ in pack n, where it is positive.
    /// @param bulkWeight  sum of weights amid bulk liquid
    FloatPack depth(int n, float reach, float bulkWeight) const
    {
        const FloatPack one = FloatPack{} + 1.0f, inverse = weight[n] > 0.0f ? 1.0f / weight[n] : FloatPack{};
        const FloatPack dx = kLaneX - x[n] * inverse, dy = kLaneY + static_cast<float>(2 * (n % kPairs)) - y[n] * inverse,
                        dz = static_cast<float>(n / kPairs) - z[n] * inverse;
        const FloatPack fromMean = sqrtFloats(dx * dx + dy * dy + dz * dz);
        FloatPack rest = sqrtFloats(sqrtFloats(sqrtFloats(sqrtFloats(sharp[n]))));  // 1 − q of a particle alone
        rest = rest < 1.0f ? rest : one;
        const FloatPack fromNearest = reach * sqrtFloats(1.0f - rest);
        FloatPack sparse = (kCrowded - weight[n] / bulkWeight) * (1.0f / (kCrowded - kSparse));
        sparse = sparse > 0.0f ? sparse : FloatPack{};
        sparse = sparse < 1.0f ? sparse : one;
        const FloatPack more = fromNearest > fromMean ? fromNearest - fromMean : FloatPack{};
        const FloatPack result = reach - (fromMean + sparse * more - radius[n] * inverse);
        return (weight[n] > 0.0f) & (result > 0.0f) ? result : FloatPack{};
    }
};

/// The packs of a block but those amid bulk liquid: in bins that like all 26 around them hold at least half the
/// particles of bulk liquid. No node of those is nearer to the surface than the edge of a bin.
std::uint32_t packsNearSurface(const BlockGrid& grid, const SurfaceParticles& particles, int block, float spacing)
{
    const double fullBin = std::pow(SurfaceParticles::kBinEdge / static_cast<double>(spacing), 3);
    bool isFull[4][4][4];
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i) {
                const int x = i + 1, y = j + 1, z = k + 1;  // bins from the lower corner of the blocks around on
                const int from = grid.neighbours(block)[neighbourIndex(x / 2 - 1, y / 2 - 1, z / 2 - 1)];
                const int bin = SurfaceParticles::kBins * from + 4 * (z % 2) + 2 * (y % 2) + x % 2;
                const int held = from == grid.count() ? 0 : particles.binStart[bin + 1] - particles.binStart[bin];
                isFull[k][j][i] = held >= 0.5 * fullBin;
            }
    const auto areFull = [&](int j, int k) {  // both bins of a row and all around them
        for (int n = 0; n < 36; ++n)
            if (!isFull[k + n / 12][j + n / 4 % 3][n % 4]) return false;
        return true;
    };
    std::uint32_t near = 0;
    for (int n = 0; n < kPacks; ++n) near |= areFull(n % kPairs / 2, n / kPairs / SurfaceParticles::kBinEdge) ? 0u : 1u << n;
    return near;
}

/// All particles in reach of a block's nodes, in the order of the blocks around it.
void addAround(const BlockGrid& grid, const SurfaceParticles& particles, float reach, int block, std::uint32_t wanted, NodeSums& sums)
{
    for (int n = 0; n < 27; ++n) {
        const int from = grid.neighbours(block)[n];
        if (from == grid.count()) continue;
        const Eigen::Vector3f corner = (kBlockEdge * Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)).cast<float>();
        for (int s = particles.begin(from); s < particles.end(from); ++s) {
            const Eigen::Vector3f at = corner + particles.place(s);
            if (at.minCoeff() > -reach && at.maxCoeff() < kBlockEdge - 1 + reach) sums.add(at, particles.radius[s], reach, wanted);
        }
    }
}

/// The nodes of a block and one more on every side.
constexpr int kHalo = kBlockEdge + 2;
using HaloBlock = std::array<std::array<std::array<float, kHalo>, kHalo>, kHalo>;

void loadWithHalo(const BlockGrid& grid, const BlockArray<float>& values, int block, HaloBlock& out)
{
    const auto& around = grid.neighbours(block);
    for (int k = 0; k < kHalo; ++k)
        for (int j = 0; j < kHalo; ++j) {
            const int row = cellInBlock(0, (j - 1) & 7, (k - 1) & 7), here = neighbourIndex(0, (j - 1) >> 3, (k - 1) >> 3);
            out[k][j][0] = values.block(around[here - 1])[row + kBlockEdge - 1];
            std::copy_n(values.block(around[here]) + row, kBlockEdge, out[k][j].begin() + 1);
            out[k][j][kHalo - 1] = values.block(around[here + 1])[row];
        }
}

/// One pass over a block, axis by axis.
void smoothBlock(const HaloBlock& v, float* out)
{
    const auto mean = [](float below, float here, float above) { return 0.25f * (below + above) + 0.5f * here; };
    float alongZ[kHalo][kHalo], alongY[kHalo];
    for (int k = 0; k < kBlockEdge; ++k) {
        for (int j = 0; j < kHalo; ++j)
            for (int i = 0; i < kHalo; ++i) alongZ[j][i] = mean(v[k][j][i], v[k + 1][j][i], v[k + 2][j][i]);
        for (int j = 0; j < kBlockEdge; ++j) {
            for (int i = 0; i < kHalo; ++i) alongY[i] = mean(alongZ[j][i], alongZ[j + 1][i], alongZ[j + 2][i]);
            for (int i = 0; i < kBlockEdge; ++i) *out++ = mean(alongY[i], alongY[i + 1], alongY[i + 2]);
        }
    }
}

}  // namespace

void surfaceField(const BlockGrid& grid, const SurfaceParticles& particles, float reach, float spacing, BlockArray<float>& depth)
{
    SIM_CHECK(reach <= kBlockEdge - 1);
    depth.resize(grid.count());
    // The integral of (1 − r²)³ over the unit ball is 64π/315.
    const float bulkWeight = static_cast<float>(64.0 * kPi / 315.0) * std::pow(reach / spacing, 3.0f);
    const float deepest = reach + static_cast<float>(std::cbrt(0.75 / kPi)) * spacing;  // where mean and place are one
    parallelFor(grid.count(), [&](std::size_t b) {
        const int block = static_cast<int>(b);
        const std::uint32_t wanted = packsNearSurface(grid, particles, block, spacing);
        NodeSums sums;
        if (wanted != 0) addAround(grid, particles, reach, block, wanted, sums);
        for (int n = 0; n < kPacks; ++n) {
            const FloatPack pack = (wanted >> n & 1) != 0 ? sums.depth(n, reach, bulkWeight) : FloatPack{} + deepest;
            std::memcpy(depth.block(block) + kFloatLanes * n, &pack, sizeof pack);
        }
    });
}

void smoothField(const BlockGrid& grid, int passes, BlockArray<float>& values, BlockArray<float>& scratch)
{
    scratch.resize(grid.count());
    for (int pass = 0; pass < passes; ++pass) {
        parallelFor(grid.count(), [&](std::size_t b) {
            HaloBlock block;
            loadWithHalo(grid, values, static_cast<int>(b), block);
            smoothBlock(block, scratch.block(static_cast<int>(b)));
        });
        values.swap(scratch);
    }
}

}  // namespace sim
