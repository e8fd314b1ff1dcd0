#include "sim/surface/surface_velocity.h"

#include "sim/core/parallel.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

constexpr std::size_t kVerticesPerTask = 256;

/// Sums over particles around one place, y from there to the particle [cells], v its velocity.
struct Moments {
    FloatPack weight = {};
    Eigen::Vector3f base = Eigen::Vector3f::Zero();  ///< v is relative to this: that of the first particle, so that
    bool hasBase = false;                            ///< sums of floats lose little
    FloatPack y[kAxes] = {}, v[kAxes] = {};          ///< Σ w y, Σ w v
    FloatPack yy[2 * kAxes] = {};                    ///< Σ w y yᵀ: xx, xy, xz, yy, yz, zz
    FloatPack vy[kAxes][kAxes] = {};                 ///< Σ w v yᵀ

    /// Add the particles first … last − 1, which are relative to a corner that lies at −`at` from the place.
    [[gnu::always_inline]] void addRun(const SurfaceParticles& particles, const Eigen::Vector3f& at, float reach, int first, int last)
    {
        if (!hasBase && first < last) {
            base = {particles.velocity[0][first], particles.velocity[1][first], particles.velocity[2][first]};
            hasBase = true;
        }
        for (int s = first; s < last; s += kFloatLanes) {
            FloatPack d[kAxes], u[kAxes];
            for (int a = 0; a < kAxes; ++a) {
                d[a] = loadFloats(particles.x[a].data() + s) - at[a];
                u[a] = loadFloats(particles.velocity[a].data() + s) - base[a];
            }
            FloatPack rest = 1.0f - (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * (1.0f / (reach * reach));
            rest = (rest > 0.0f) & firstFloatLanes(last - s) ? rest : FloatPack{};
            const FloatPack w = rest * rest * rest;
            weight += w;
            int n = 0;
            for (int a = 0; a < kAxes; ++a) {
                const FloatPack wd = w * d[a];
                y[a] += wd;
                v[a] += w * u[a];
                for (int b = a; b < kAxes; ++b) yy[n++] += wd * d[b];
                for (int b = 0; b < kAxes; ++b) vy[b][a] += wd * u[b];
            }
        }
    }

    /// The affine fit at the place itself.
    Vec3 fit() const
    {
        // Variance [cells²] below which particles count as lying in a plane: where they fill a half space it is
        // about 1.
        constexpr double kFlat = 0.002;
        const double total = sumFloatLanes(weight);
        if (!(total > 0.0)) return Vec3::Zero();
        Vec3 meanY, meanV;
        Mat3 spread, change;
        int n = 0;
        for (int a = 0; a < kAxes; ++a) {
            meanY[a] = sumFloatLanes(y[a]) / total;
            meanV[a] = sumFloatLanes(v[a]) / total;
            for (int b = a; b < kAxes; ++b) spread(a, b) = spread(b, a) = sumFloatLanes(yy[n++]) / total;
            for (int b = 0; b < kAxes; ++b) change(b, a) = sumFloatLanes(vy[b][a]) / total;
        }
        spread += kFlat * Mat3::Identity() - meanY * meanY.transpose();
        change -= meanV * meanY.transpose();
        return base.cast<double>() + meanV - change * (spread.inverse() * meanY);
    }
};

/// Numbers of bins along one axis, from a block's first on, in reach of a place in the block.
std::array<int, 2> binsInReach(float place, float reach)
{
    const auto bin = [](float v) { return static_cast<int>(std::floor(v / SurfaceParticles::kBinEdge)); };
    return {bin(place - reach), bin(place + reach)};
}

/// Sums over the particles around one crossing.
class Around {
 public:
    Around(const BlockGrid& grid, const SurfaceParticles& particles, const Crossing& crossing, float reach)
        : grid_(grid), particles_(particles), block_(crossing.block), place_(crossing.place()), reach_(reach)
    {
        const auto x = binsInReach(place_.x(), reach), y = binsInReach(place_.y(), reach), z = binsInReach(place_.z(), reach);
        for (int k = z[0]; k <= z[1]; ++k)
            for (int j = y[0]; j <= y[1]; ++j) addRow(x, j, k);
    }

    const Moments& moments() const { return moments_; }

 private:
    /// Particles in the bins x … of one row of bins, which are runs as long as they are in one block.
    void addRow(const std::array<int, 2>& x, int y, int z)
    {
        for (int i = x[0]; i <= x[1];) {
            const Vec3i step(i >> 1, y >> 1, z >> 1);
            const int block = grid_.neighbours(block_)[neighbourIndex(step.x(), step.y(), step.z())];
            const int last = std::min(x[1], i | 1);
            if (block != grid_.count()) {
                const int* bins = particles_.binStart.data() + SurfaceParticles::kBins * block + 4 * (z & 1) + 2 * (y & 1);
                moments_.addRun(particles_, place_ - (kBlockEdge * step).cast<float>(), reach_, bins[i & 1], bins[(last & 1) + 1]);
            }
            i = last + 1;
        }
    }

    const BlockGrid& grid_;
    const SurfaceParticles& particles_;
    int block_;
    Eigen::Vector3f place_;
    float reach_;  ///< [cells]
    Moments moments_;
};

}  // namespace

void surfaceVelocities(const BlockGrid& grid, const SurfaceParticles& particles, float reach, const std::vector<Crossing>& crossings,
                       std::vector<Vec3>& velocities)
{
    velocities.resize(crossings.size());
    parallelFor(crossings.size(), kVerticesPerTask,
                [&](std::size_t c) { velocities[c] = Around(grid, particles, crossings[c], reach).moments().fit(); });
}

}  // namespace sim
