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

/// The pushes on one particle: Σ (1 − d²/R²)³ (x_i − x_j)/d.
struct Push {
    Vec3 at;
    int self;
    double inverseReachSquared;
    Pack x = broadcast(0.0), y = broadcast(0.0), z = broadcast(0.0);
    Vec3 coincident = Vec3::Zero();

    /// Add those of the particles first … last − 1.
    [[gnu::always_inline]] void addRun(const LiquidParticles& particles, int first, int last)
    {
        for (int s = first; s < last; s += kLanes) {
            const PackMask lanes = firstLanes(last - s);
            const Pack dx = at.x() - loadPack(particles.x[0].data() + s), dy = at.y() - loadPack(particles.x[1].data() + s),
                       dz = at.z() - loadPack(particles.x[2].data() + s);
            const Pack square = dx * dx + dy * dy + dz * dz, rest = 1.0 - square * inverseReachSquared;
            const PackMask near = (rest > 0.0) & lanes;
            if (maskBits(near) == 0) continue;
            const PackMask apart = near & (square > 0.0);
            const unsigned same = maskBits(near & (square == 0.0));
            if (same != 0) addCoincident(particles, same, s);
            const Pack strength = select(apart, rest * rest * rest / sqrtPack(select(apart, square, broadcast(1.0))), broadcast(0.0));
            x += strength * dx;
            y += strength * dy;
            z += strength * dz;
        }
    }

    void addCoincident(const LiquidParticles& particles, unsigned lanes, int first)
    {
        for (int l = 0; l < kLanes; ++l)
            if ((lanes >> l & 1) != 0 && first + l != self) coincident += directionOfPair(particles.id[self], particles.id[first + l]);
    }

    Vec3 sum() const { return coincident + Vec3(sumLanes(x), sumLanes(y), sumLanes(z)); }
};

/// Pushes by the particles of all cells within reach. Along z the cells of a block are one run.
void addNeighbours(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, int block, double reach, Push& push)
{
    int low[3], high[3];
    const Vec3 inCells = (push.at - grid.lowerCorner(block)) / grid.dx;
    for (int a = 0; a < kAxes; ++a) {
        low[a] = static_cast<int>(std::floor(inCells[a] - reach / grid.dx));
        high[a] = static_cast<int>(std::floor(inCells[a] + reach / grid.dx));
    }
    for (int i = low[0]; i <= high[0]; ++i)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int k = low[2]; k <= high[2];) {
                const int last = std::min(high[2], k | 7);  // to the end of the block
                const int b = grid.neighbours(block)[neighbourIndex(i >> 3, j >> 3, k >> 3)];
                if (b != grid.count()) {
                    const int* cells = order.cells(b);
                    push.addRun(particles, cells[cellRank(i & 7, j & 7, k & 7)], cells[cellRank(i & 7, j & 7, last & 7) + 1]);
                }
                k = last + 1;
            }
}

}  // namespace

void relaxationDisplacements(const LiquidParticles& particles, const ParticleOrder& order, const BlockGrid& grid, double rate, double reach,
                             double dt, std::array<AlignedArray<double>, kAxes>& displacement)
{
    for (auto& d : displacement) d.resize(particles.mass.size());
    const double scale = std::min(1.0, rate * dt) * reach;
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int block = order.occupied[n];
        for (int s = order.begin(block); s < order.end(block); ++s) {
            Push push{particles.position(s), s, 1.0 / (reach * reach)};
            addNeighbours(particles, order, grid, block, reach, push);
            const Vec3 d = scale * push.sum();
            for (int a = 0; a < kAxes; ++a) displacement[a][s] = d[a];
        }
    });
}

}  // namespace sim
