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

constexpr float kTiny = 1.0e-12f;  ///< keeps the direction to oneself, 0/0, at 0

/// Positions relative to the lower corner of the particle's block, in units of the reach: floats are exact enough there.
struct LocalPositions {
    const float *x, *y, *z;
};

/// The pushes on one particle: Σ (1 − q)³ (x_i − x_j)/d, q = d²/reach².
struct Push {
    FloatPack x{}, y{}, z{};
    FloatMask same{};  ///< counts those that are at (almost) the same place, itself included

    /// Add those by the particles first … last − 1, which stand in neighbouring cells of one block along z.
    /// @param at  the particle, relative to the corner of that block
    [[gnu::always_inline]] void addRun(const LocalPositions& positions, float atX, float atY, float atZ, int first, int last)
    {
        for (int s = first; s < last; s += kFloatLanes) {
            const FloatPack dx = atX - loadFloats(positions.x + s), dy = atY - loadFloats(positions.y + s), dz = atZ - loadFloats(positions.z + s);
            const FloatPack q = dx * dx + dy * dy + dz * dz;
            FloatPack rest = 1.0f - q;
            rest = (rest > 0.0f) & firstFloatLanes(last - s) ? rest : FloatPack{};
            const FloatPack strength = rest * rest * rest * roughInverseSqrt(q + kTiny);
            x += strength * dx;
            y += strength * dy;
            z += strength * dz;
            same += rest == 1.0f;
        }
    }
    Vec3 sum() const { return {sumFloatLanes(x), sumFloatLanes(y), sumFloatLanes(z)}; }
};

/// Directions away from particles of the same cell that are at the same place, as far as floats can tell.
Vec3 separateCoincident(const Particles& particles, const LocalPositions& local, int self, int first, int last)
{
    const auto samePlace = [&](int s) { return local.x[s] == local.x[self] && local.y[s] == local.y[self] && local.z[s] == local.z[self]; };
    Vec3 sum = Vec3::Zero();
    for (int s = first; s < last; ++s)
        if (s != self && samePlace(s)) sum += directionOfPair(particles.id[self], particles.id[s]);
    return sum;
}

/// The three cells of one column around a cell, below to above.
struct Column {
    int begin[3], end[3];
    float offsetX, offsetY, offsetZ[3];  ///< places of their blocks' corners against that of the cell's block, in units of the reach
};

/// The 3×3 columns around a cell, x first. Absent blocks hold empty runs.
struct Neighbourhood {
    Column columns[9];

    Neighbourhood(const ParticleOrder& order, const BlockGrid& grid, int block, const Vec3i& cell, float blockEdge)
    {
        for (int c = 0; c < 9; ++c) {
            const int ci = cell.x() + c % 3 - 1, cj = cell.y() + c / 3 - 1;
            Column& column = columns[c];
            column.offsetX = blockEdge * static_cast<float>(ci >> 3);
            column.offsetY = blockEdge * static_cast<float>(cj >> 3);
            for (int n = 0; n < 3; ++n) {
                const int ck = cell.z() + n - 1, b = grid.neighbours(block)[neighbourIndex(ci >> 3, cj >> 3, ck >> 3)];
                const bool exists = b != grid.count();
                const int* start = exists ? order.cells(b) + cellRank(ci & 7, cj & 7, ck & 7) : nullptr;
                column.begin[n] = exists ? start[0] : 0;
                column.end[n] = exists ? start[1] : 0;
                column.offsetZ[n] = blockEdge * static_cast<float>(ck >> 3);
            }
        }
    }
};

/// Pushes by the cells low … high of a column, which are one run wherever they are in one block.
[[gnu::always_inline]] inline void addColumn(const LocalPositions& local, const Column& column, const Eigen::Vector3f& at, int low, int high,
                                             Push& push)
{
    const float x = at.x() - column.offsetX, y = at.y() - column.offsetY;
    while (low <= high) {
        int last = low;
        while (last < high && column.offsetZ[last + 1] == column.offsetZ[low]) ++last;
        push.addRun(local, x, y, at.z() - column.offsetZ[low], column.begin[low], column.end[last]);
        low = last + 1;
    }
}

/// Pushes the particles of one cell after another.
class Repulsion {
 public:
    /// @param reach  of a push [cm]
    /// @param scale  displacement per push [cm]
    Repulsion(const SortedParticles& sorted, const LocalPositions& local, double reach, double scale)
        : sorted_(sorted), local_(local), cellsPerReach_(static_cast<float>(reach / sorted.grid.dx)), scale_(scale)
    {
    }

    void push(int block, const Vec3i& cell, std::array<AlignedArray<double>, kAxes>& displacement) const
    {
        const int* start = sorted_.order.cells(block) + cellRank(cell.x(), cell.y(), cell.z());
        if (start[0] == start[1]) return;
        const Neighbourhood around(sorted_.order, sorted_.grid, block, cell, kBlockEdge / cellsPerReach_);
        const Eigen::Vector3f lower = cell.cast<float>() / cellsPerReach_, upper = (cell + Vec3i::Ones()).cast<float>() / cellsPerReach_;
        for (int s = start[0]; s < start[1]; ++s) {
            const Eigen::Vector3f at(local_.x[s], local_.y[s], local_.z[s]);
            int low[3], high[3];  // of the three cells along each axis, those within reach
            for (int a = 0; a < kAxes; ++a) {
                low[a] = at[a] - lower[a] < 1.0f ? 0 : 1;
                high[a] = upper[a] - at[a] < 1.0f ? 2 : 1;
            }
            Push push;
            for (int j = low[1]; j <= high[1]; ++j)
                for (int i = low[0]; i <= high[0]; ++i) addColumn(local_, around.columns[3 * j + i], at, low[2], high[2], push);
            Vec3 sum = push.sum();
            if (sumFloatLanes(push.same) != -1) sum += separateCoincident(sorted_.particles, local_, s, start[0], start[1]);
            for (int a = 0; a < kAxes; ++a) displacement[a][s] = scale_ * sum[a];
        }
    }

 private:
    const SortedParticles& sorted_;
    LocalPositions local_;
    float cellsPerReach_;
    double scale_;
};

}  // namespace

void relaxationDisplacements(const SortedParticles& sorted, double rate, double reach, double interval, RelaxScratch& scratch,
                             std::array<AlignedArray<double>, kAxes>& displacement)
{
    const Particles& particles = sorted.particles;
    const ParticleOrder& order = sorted.order;
    for (int a = 0; a < kAxes; ++a) {
        displacement[a].resize(particles.mass.size());
        scratch.local[a].resize(particles.mass.size());
    }
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        const int b = order.occupied[n];
        const Vec3 corner = sorted.grid.lowerCorner(b);
        for (int a = 0; a < kAxes; ++a)
            for (int s = order.begin(b); s < order.end(b); ++s)
                scratch.local[a][s] = static_cast<float>((particles.x[a][s] - corner[a]) * (1.0 / reach));
    });
    const LocalPositions local{scratch.local[0].data(), scratch.local[1].data(), scratch.local[2].data()};
    const Repulsion crowd(sorted, local, reach, std::min(1.0, rate * interval) * reach);
    parallelFor(order.occupied.size(), [&](std::size_t n) {
        for (int c = 0; c < kBlockCells; ++c) crowd.push(order.occupied[n], {c >> 6, c >> 3 & 7, c & 7}, displacement);
    });
}

}  // namespace sim
