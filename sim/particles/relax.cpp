#include "sim/particles/relax.h"

#include "sim/core/parallel.h"
#include "sim/core/simd.h"
#include "sim/core/units.h"

#include <cmath>

namespace sim {

namespace {

/// Direction in which particle a leaves particle b when both are at the same place: isotropic over pairs, opposite for the other one.
Vec3 directionOfPair(std::uint32_t a, std::uint32_t b)
{
    std::uint64_t h = (static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b)) * 0x9e3779b97f4a7c15u;
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
    const double z = 2.0 * static_cast<double>(h & 0xffffffff) / 4294967296.0 - 1.0;
    const double angle = 2.0 * kPi * static_cast<double>(h >> 32) / 4294967296.0, s = std::sqrt(1.0 - z * z);
    const Vec3 direction(s * std::cos(angle), s * std::sin(angle), z);
    return a < b ? direction : Vec3(-direction);
}

/// Positions relative to the lower corner of the particle's block, in units of the reach: floats are exact enough there.
struct LocalPositions {
    const float *x, *y, *z;
};

/// The pushes on one particle: Σ (1 − q)³ (x_i − x_j)/d, q = d²/reach², over the particles first … last − 1 of runs of cells.
struct Push {
    FloatPack x{}, y{}, z{};
    FloatMask same{};  ///< counts those that are at (almost) the same place, itself included

    /// @param at  the particle, relative to the corner of the run's block
    [[gnu::always_inline]] void addRun(const LocalPositions& positions, const Eigen::Vector3f& at, int first, int last)
    {
        for (int s = first; s < last; s += kFloatLanes) {
            const FloatPack dx = at.x() - loadFloats(positions.x + s), dy = at.y() - loadFloats(positions.y + s),
                            dz = at.z() - loadFloats(positions.z + s);
            const FloatPack q = dx * dx + dy * dy + dz * dz;
            FloatPack rest = 1.0f - q;
            rest = rest > 0.0f ? rest : FloatPack{};
            if (last - s < kFloatLanes) rest = firstFloatLanes(last - s) ? rest : FloatPack{};
            const FloatPack strength = rest * rest * rest * inverseSqrt(q);  // finite where q = 0, times a distance of 0
            x += strength * dx;
            y += strength * dy;
            z += strength * dz;
            same += rest == 1.0f;
        }
    }
    Vec3 sum() const { return {sumFloatLanes(x), sumFloatLanes(y), sumFloatLanes(z)}; }
};

/// Directions away from particles at the same place, as far as floats can tell: they stand in the same block.
Vec3 leaveCoincident(const LiquidParticles& particles, const LocalPositions& local, int self, int first, int last)
{
    Vec3 sum = Vec3::Zero();
    for (int s = first; s < last; ++s)
        if (s != self && local.x[s] == local.x[self] && local.y[s] == local.y[self] && local.z[s] == local.z[self]) sum += directionOfPair(particles.id[self], particles.id[s]);
    return sum;
}

/// The sum over all cells within reach. Along z the cells of a block are one run.
Vec3 pushOn(const LiquidParticles& particles, const LocalPositions& local, const ParticleOrder& order, const BlockGrid& grid, int block, int self,
            float cellsPerReach)
{
    const float blockEdge = kBlockEdge / cellsPerReach;
    const Eigen::Vector3f at(local.x[self], local.y[self], local.z[self]);
    int low[3], high[3];
    for (int a = 0; a < kAxes; ++a) {
        low[a] = static_cast<int>(std::floor((at[a] - 1.0f) * cellsPerReach));
        high[a] = static_cast<int>(std::floor((at[a] + 1.0f) * cellsPerReach));
    }
    Push push;
    for (int i = low[0]; i <= high[0]; ++i)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int k = low[2]; k <= high[2];) {
                const int last = std::min(high[2], k | 7);  // to the end of the block
                const Vec3i offset(i >> 3, j >> 3, k >> 3);
                const int b = grid.neighbours(block)[neighbourIndex(offset.x(), offset.y(), offset.z())];
                if (b != grid.count()) {
                    const int* cells = order.cells(b);
                    const int begin = cells[cellRank(i & 7, j & 7, k & 7)], end = cells[cellRank(i & 7, j & 7, last & 7) + 1];
                    push.addRun(local, at - blockEdge * offset.cast<float>(), begin, end);
                }
                k = last + 1;
            }
    if (sumFloatLanes(push.same) == -1) return push.sum();
    return push.sum() + leaveCoincident(particles, local, self, order.begin(block), order.end(block));
}

}  // namespace

void relaxationDisplacements(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, double rate, double reach,
                             double dt, RelaxScratch& scratch, std::array<AlignedArray<double>, kAxes>& displacement)
{
    for (int a = 0; a < kAxes; ++a) {
        displacement[a].resize(particles.mass.size());
        scratch.local[a].resize(particles.mass.size());
    }
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int b = order.occupied[n];
        const Vec3 corner = grid.lowerCorner(b);
        for (int a = 0; a < kAxes; ++a)
            for (int s = order.begin(b); s < order.end(b); ++s)
                scratch.local[a][s] = static_cast<float>((particles.x[a][s] - corner[a]) * (1.0 / reach));
    });
    const LocalPositions local{scratch.local[0].data(), scratch.local[1].data(), scratch.local[2].data()};
    const double scale = std::min(1.0, rate * dt) * reach;
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int block = order.occupied[n];
        for (int s = order.begin(block); s < order.end(block); ++s) {
            const Vec3 d = scale * pushOn(particles, local, order, grid, block, s, static_cast<float>(reach / grid.dx));
            for (int a = 0; a < kAxes; ++a) displacement[a][s] = d[a];
        }
    });
}

}  // namespace sim
