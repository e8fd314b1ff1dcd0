#include "sim/surface/surface_field.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Two rows of 8 nodes side by side: the block is 8 planes of 4 such pairs.
constexpr int kPairs = kBlockEdge / 2, kPacks = kBlockEdge * kPairs;
static_assert(kFloatLanes == 2 * kBlockEdge);

constexpr FloatPack kLaneX = {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7};
constexpr FloatPack kLaneY = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};

/// Sums over particles at the nodes of one block, with the weights (1 − d²/reach²)³.
struct NodeSums {
    FloatPack weight[kPacks] = {}, x[kPacks] = {}, y[kPacks] = {}, z[kPacks] = {}, radius[kPacks] = {};

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
                const FloatPack w = rest * rest * rest;
                const int n = kPairs * k + j;
                weight[n] += w;
                x[n] += w * at.x();
                y[n] += w * at.y();
                z[n] += w * at.z();
                radius[n] += w * particleRadius;
            }
        }
    }
};

/// All particles in reach of a block's nodes, in the order of the blocks around it.
void addAround(const BlockGrid& grid, const SurfaceParticles& particles, float reach, int block, NodeSums& sums)
{
    for (int n = 0; n < 27; ++n) {
        const int from = grid.neighbours(block)[n];
        if (from == grid.count()) continue;
        const Eigen::Vector3f corner =
            kBlockEdge * Eigen::Vector3f(static_cast<float>(n % 3 - 1), static_cast<float>(n / 3 % 3 - 1),
                                         static_cast<float>(n / 9 - 1));
        for (int s = particles.begin(from); s < particles.end(from); ++s) {
            const Eigen::Vector3f at =
                corner + Eigen::Vector3f(particles.x[0][s], particles.x[1][s], particles.x[2][s]);
            if (at.minCoeff() <= -reach || at.maxCoeff() >= kBlockEdge - 1 + reach) continue;
            sums.add(at, particles.radius[s], reach);
        }
    }
}

float depthAt(const Eigen::Vector3f& node, const Eigen::Vector3f& sumOfPlaces, float sumOfRadii, float weight,
              float reach)
{
    if (!(weight > 0.0f)) return 0.0f;
    const float radius = sumOfRadii / weight, atRadius = std::max(0.0f, 1.0f - radius * radius / (reach * reach)),
                enough = 0.7f * atRadius * atRadius * atRadius, lack = std::max(0.0f, 1.0f - weight / enough);
    const float distance = (node - sumOfPlaces / weight).norm() - radius + reach * lack * lack;
    return std::max(0.0f, reach - distance);
}

}  // namespace

void surfaceField(const BlockGrid& grid, const SurfaceParticles& particles, float reach, BlockArray<float>& depth)
{
    SIM_CHECK(reach <= kBlockEdge - 1);
    depth.resize(grid.count());
    parallelFor(grid.count(), [&](std::size_t b) {
        const int block = static_cast<int>(b);
        NodeSums sums;
        addAround(grid, particles, reach, block, sums);
        float* out = depth.block(block);
        for (int c = 0; c < kBlockCells; ++c) {
            const int pack = c / kFloatLanes, lane = c % kFloatLanes;
            const Eigen::Vector3f node(static_cast<float>(c & 7), static_cast<float>(c >> 3 & 7),
                                       static_cast<float>(c >> 6));
            out[c] = depthAt(node, {sums.x[pack][lane], sums.y[pack][lane], sums.z[pack][lane]},
                             sums.radius[pack][lane], sums.weight[pack][lane], reach);
        }
    });
}

}  // namespace sim
