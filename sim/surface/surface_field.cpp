#include "sim/surface/surface_field.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"
#include "sim/core/units.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace sim {

namespace {

/// Two rows of 8 nodes side by side in a pack: a block is 8 planes of 4 packs.
constexpr int kPairs = kBlockEdge / 2, kPacks = kBlockEdge * kPairs;
static_assert(kFloatLanes == 2 * kBlockEdge);

constexpr FloatPack kLaneX = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
constexpr FloatPack kLaneY = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};

/// Sums of weights relative to that amid bulk liquid: up to the first, as between a few drops, the nearest particle
/// tells the distance; from the second on, as at a bulk surface, the mean place does.
constexpr float kSparse = 0.17f, kCrowded = 0.41f;

/// Σ w, Σ w x … over particles at the nodes of one block, w = (1 − q)³ and q = d²/reach², and Σ (1 − q)¹⁶.
struct NodeSums {
    FloatPack weight[kPacks] = {}, x[kPacks] = {}, y[kPacks] = {}, z[kPacks] = {}, radius[kPacks] = {},
              sharp[kPacks] = {};

    /// @param at  place of the particle relative to the lower corner of the block [cells]
    [[gnu::always_inline]] void add(const Eigen::Vector3f& at, float particleRadius, float reach)
    {
        const auto low = [&](float v) { return std::max(0, static_cast<int>(std::ceil(v - reach))); };
        const auto high = [&](float v) { return std::min(kBlockEdge - 1, static_cast<int>(std::floor(v + reach))); };
        const float scale = 1.0f / (reach * reach);
        const FloatPack dx = kLaneX - at.x(), restX = 1.0f - scale * (dx * dx);
        for (int k = low(at.z()); k <= high(at.z()); ++k) {
            const float dz = static_cast<float>(k) - at.z();
            const FloatPack restXZ = restX - scale * dz * dz;
            for (int j = low(at.y()) / 2; j <= high(at.y()) / 2; ++j) {
                const FloatPack dy = kLaneY + (static_cast<float>(2 * j) - at.y());
                FloatPack rest = restXZ - scale * (dy * dy);
                rest = rest > 0.0f ? rest : FloatPack{};
                const FloatPack squared = rest * rest, w = squared * rest;
                FloatPack power = squared * squared;
                power *= power;
                const int n = kPairs * k + j;
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
        const FloatPack dx = kLaneX - x[n] * inverse,
                        dy = kLaneY + static_cast<float>(2 * (n % kPairs)) - y[n] * inverse,
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

/// All particles in reach of a block's nodes, in the order of the blocks around it.
void addAround(const BlockGrid& grid, const SurfaceParticles& particles, float reach, int block, NodeSums& sums)
{
    for (int n = 0; n < 27; ++n) {
        const int from = grid.neighbours(block)[n];
        if (from == grid.count()) continue;
        const Eigen::Vector3f corner = (kBlockEdge * Vec3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)).cast<float>();
        for (int s = particles.begin(from); s < particles.end(from); ++s) {
            const Eigen::Vector3f at = corner + particles.place(s);
            if (at.minCoeff() > -reach && at.maxCoeff() < kBlockEdge - 1 + reach)
                sums.add(at, particles.radius[s], reach);
        }
    }
}

}  // namespace

void surfaceField(const BlockGrid& grid, const SurfaceParticles& particles, float reach, float spacing,
                  BlockArray<float>& depth)
{
    SIM_CHECK(reach <= kBlockEdge - 1);
    depth.resize(grid.count());
    // The integral of (1 − r²)³ over the unit ball is 64π/315.
    const float bulkWeight = static_cast<float>(64.0 * kPi / 315.0) * std::pow(reach / spacing, 3.0f);
    parallelFor(grid.count(), [&](std::size_t b) {
        const int block = static_cast<int>(b);
        NodeSums sums;
        addAround(grid, particles, reach, block, sums);
        for (int n = 0; n < kPacks; ++n) {
            const FloatPack pack = sums.depth(n, reach, bulkWeight);
            std::memcpy(depth.block(block) + kFloatLanes * n, &pack, sizeof pack);
        }
    });
}

}  // namespace sim
