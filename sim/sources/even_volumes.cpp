#include "sim/sources/even_volumes.h"

#include "sim/core/parallel.h"
#include "sim/core/spline.h"
#include "sim/grid/room.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace sim {

namespace {

constexpr int kSweeps = 20;           ///< leave the volume of a cell of the grid within .5 % of what the region has of it, but in slivers
constexpr double kRight = 2.0e-3;     ///< particles whose first factor is as near to 1 stay as they are, for most of a lattice is even [-]
constexpr double kLeastShare = 0.02;  ///< volume of a particle in a sliver that the grid does not see, of the mean of all [-]
constexpr double kLeastSum = 1.0e-6;  ///< a face with less of particles than this tells nothing [cells]
constexpr int kTileEdge = 11;         ///< nodes −1 … 9 of a block along each axis, which its particles reach
constexpr int kColors = 8;            ///< blocks of one parity share no face that their particles reach

/// A factor to the power 1.75: the iteration converges below 2.
double overRelaxed(double factor) { return factor * std::sqrt(factor) * std::sqrt(std::sqrt(factor)); }

constexpr int tileIndex(int i, int j, int k) { return (i + 1) + kTileEdge * ((j + 1) + kTileEdge * (k + 1)); }

/// Values at the lower faces that the particles of a block reach.
using Tile = std::array<std::array<double, kTileEdge * kTileEdge * kTileEdge>, kAxes>;

/// Weights of a particle at the faces around it.
class FaceStencil {
 public:
    /// @param place  from the lower corner of its block on [cells]
    explicit FaceStencil(const Vec3& place)
    {
        for (int a = 0; a < kAxes; ++a)
            for (int middle = 0; middle < 2; ++middle) {
                const double at = place[a] - 0.5 * middle;
                const int first = static_cast<int>(std::floor(at - 0.5));
                first_[middle][a] = first;
                splineWeights(at - first - 1.0, weight_[middle][a]);
            }
    }

    /// Call f(axis, index in the tile, weight) for the 27 faces of each axis.
    template <class F>
    void forEachFace(F&& f) const
    {
        for (int a = 0; a < kAxes; ++a) {
            const int x = a != 0, y = a != 1, z = a != 2;  // around faces across the axis, around middles along it
            const int corner = tileIndex(first_[x][0], first_[y][1], first_[z][2]);
            for (int k = 0; k < 3; ++k)
                for (int j = 0; j < 3; ++j) {
                    const double yz = weight_[y][1][j] * weight_[z][2][k];
                    for (int i = 0; i < 3; ++i) f(a, corner + i + kTileEdge * (j + kTileEdge * k), weight_[x][0][i] * yz);
                }
        }
    }

 private:
    std::array<std::array<int, kAxes>, 2> first_;  ///< face, middle
    std::array<std::array<std::array<double, 3>, kAxes>, 2> weight_;
};

/// Particles by blocks of the grid, and the blocks whose faces they reach.
struct Bins {
    BlockGrid grid;
    std::vector<int> order;                         ///< particles, block by block
    std::vector<int> begin;                         ///< per block and one more, in `order`
    std::array<std::vector<int>, kColors> byColor;  ///< blocks with particles

    Bins(std::span<const Vec3> positions, double dx, const Vec3& origin)
    {
        grid.dx = dx;
        grid.origin = origin;
        std::vector<Vec3i> blocks(positions.size());
        parallelFor(positions.size(), 4096,
                    [&](std::size_t p) { blocks[p] = (((positions[p] - origin) / dx).array().floor() / kBlockEdge).floor().cast<int>(); });
        setBlocks(blocks);
        std::vector<int> number(positions.size());
        parallelFor(positions.size(), 4096, [&](std::size_t p) { number[p] = grid.find(blocks[p]); });
        sort(number);
    }

 private:
    void setBlocks(std::vector<Vec3i> blocks)
    {
        const auto less = [](const Vec3i& a, const Vec3i& b) { return std::ranges::lexicographical_compare(a, b); };
        const auto unify = [&] {
            std::ranges::sort(blocks, less);
            blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        };
        unify();
        const std::size_t occupied = blocks.size();
        for (std::size_t n = 0; n < occupied; ++n)
            for (int i = 0; i < 27; ++i) blocks.push_back(blocks[n] + Vec3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        unify();
        grid.setBlocks(blocks);
    }
    void sort(const std::vector<int>& number)
    {
        begin.assign(static_cast<std::size_t>(grid.count()) + 1, 0);
        for (const int b : number) ++begin[static_cast<std::size_t>(b) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        order.resize(number.size());
        std::vector<int> next(begin);
        for (std::size_t p = 0; p < number.size(); ++p) order[next[number[p]]++] = static_cast<int>(p);
        for (int b = 0; b < grid.count(); ++b) {
            const Vec3i& c = grid.coords(b);
            if (begin[b] < begin[b + 1]) byColor[(c[0] & 1) + 2 * (c[1] & 1) + 4 * (c[2] & 1)].push_back(b);
        }
    }
};

/// Call f(axis, index in the tile, block, face) for the faces of a tile.
template <class F>
void forEachTileFace(const BlockGrid& grid, int block, F&& f)
{
    for (int k = -1; k < kTileEdge - 1; ++k)
        for (int j = -1; j < kTileEdge - 1; ++j)
            for (int i = -1; i < kTileEdge - 1; ++i) {
                const CellRef face = cellNear(grid, block, i, j, k);
                for (int a = 0; a < kAxes; ++a) f(a, tileIndex(i, j, k), face.block, face.cell);
            }
}

/// Finds volumes by the multiplicative iteration of Richardson 1972 and Lucy 1974: each particle's grows by the mean ratio of what the
/// faces around it should have and have.
class Evening {
 public:
    Evening(const Shape& region, std::span<const Vec3> positions, double dx, const Vec3& origin) : positions_(positions), bins_(positions, dx, origin)
    {
        end_.assign(bins_.begin.begin() + 1, bins_.begin.end());
        target_.resize(bins_.grid.count());
        sums_.resize(bins_.grid.count());
        ratio_.resize(bins_.grid.count());
        findTarget(region);
    }

    /// @param volumes  of the particles [cells]
    void sweep(std::vector<double>& volumes)
    {
        const bool isFirst = base_.size() == 0;
        if (isFirst) clear(sums_);
        else copy(base_, sums_);
        inColors([&](int b) { addParticles(b, bins_.begin[b], end_[b], volumes, sums_); });
        parallelFor(bins_.grid.count(), 8, [&](std::size_t n) {
            const int b = static_cast<int>(n);
            double* ratio = ratio_.block(b);
            const double *sum = sums_.block(b), *target = target_.block(b);
            for (std::size_t f = 0; f < sums_.kStride; ++f) ratio[f] = sum[f] > kLeastSum ? target[f] / sum[f] : 1.0;
        });
        inColors([&](int b) { multiply(b, isFirst, volumes); });
        if (!isFirst) return;
        base_.resize(bins_.grid.count());
        clear(base_);
        inColors([&](int b) { addParticles(b, end_[b], bins_.begin[b + 1], volumes, base_); });
    }

 private:
    /// Share of each face's B-spline that is in the region.
    void findTarget(const Shape& region)
    {
        const BlockGrid& grid = bins_.grid;
        Obstacles outside;
        outside.add(region.inverted(), Motion());
        outside.moveTo(0.0, 0.0);
        const double reach = std::sqrt(3.0) * (0.5 * kBlockEdge + OpenParts::kRim) * grid.dx;
        std::vector<std::unique_ptr<RoomScratch>> scratch(workerCount());
        parallelForWorkers(grid.count(), 1, [&](std::size_t n, int worker) {
            const int b = static_cast<int>(n);
            const double distance = region.distance(grid.lowerCorner(b) + Vec3::Constant(0.5 * kBlockEdge * grid.dx));
            if (std::abs(distance) > reach) {
                std::fill_n(target_.block(b), target_.kStride, distance < 0.0 ? 1.0 : 0.0);
                return;
            }
            if (!scratch[worker]) scratch[worker] = std::make_unique<RoomScratch>();
            roomOfFaces(grid, b, outside, false, *scratch[worker], target_.block(b));
        });
    }
    FaceStencil stencil(int block, int p) const { return FaceStencil((positions_[p] - bins_.grid.lowerCorner(block)) / bins_.grid.dx); }
    void clear(BlockArray<double, 3>& faces) const
    {
        parallelFor(bins_.grid.count(), 8, [&](std::size_t b) { std::fill_n(faces.block(static_cast<int>(b)), faces.kStride, 0.0); });
    }
    void copy(const BlockArray<double, 3>& from, BlockArray<double, 3>& to) const
    {
        parallelFor(bins_.grid.count(), 8,
                    [&](std::size_t b) { std::copy_n(from.block(static_cast<int>(b)), from.kStride, to.block(static_cast<int>(b))); });
    }
    /// Call f(block) for all that have particles, at the same time only for such that share no face.
    template <class F>
    void inColors(F&& f) const
    {
        for (const std::vector<int>& blocks : bins_.byColor) parallelFor(blocks.size(), [&](std::size_t n) { f(blocks[n]); });
    }
    /// Adds what those of a block from `first` to `last` in the bins bring to its faces.
    void addParticles(int block, int first, int last, const std::vector<double>& volumes, BlockArray<double, 3>& sums) const
    {
        if (first == last) return;
        Tile tile{};
        for (int n = first; n < last; ++n) {
            const double volume = volumes[bins_.order[n]];
            stencil(block, bins_.order[n]).forEachFace([&](int a, int at, double weight) { tile[a][at] += weight * volume; });
        }
        forEachTileFace(bins_.grid, block, [&](int a, int at, int b, int face) { sums.block(b, a)[face] += tile[a][at]; });
    }
    /// @param sorts  particles that are right already go to the end of their block, where they are left alone
    void multiply(int block, bool sorts, std::vector<double>& volumes)
    {
        if (bins_.begin[block] == end_[block]) return;
        Tile tile;
        forEachTileFace(bins_.grid, block, [&](int a, int at, int b, int face) { tile[a][at] = ratio_.block(b, a)[face]; });
        for (int n = bins_.begin[block]; n < end_[block];) {
            double sum = 0.0;
            stencil(block, bins_.order[n]).forEachFace([&](int a, int at, double weight) { sum += weight * tile[a][at]; });
            const double factor = sum / kAxes;
            if (sorts && std::abs(factor - 1.0) < kRight) std::swap(bins_.order[n], bins_.order[--end_[block]]);
            else volumes[bins_.order[n++]] *= overRelaxed(factor);
        }
    }

    std::span<const Vec3> positions_;
    Bins bins_;
    std::vector<int> end_;          ///< per block, in the bins: of the particles that are not left alone
    BlockArray<double, 3> target_;  ///< share of each lower face's B-spline that is in the region [-]
    BlockArray<double, 3> base_;    ///< what particles bring there that are left alone [cells]
    BlockArray<double, 3> sums_;    ///< what all bring [cells]
    BlockArray<double, 3> ratio_;   ///< ratio of each face's share to what all particles bring [-]
};

}  // namespace

std::vector<double> evenVolumes(const Shape& region, std::span<const Vec3> positions, double volume, double dx, const Vec3& origin)
{
    const double mean = volume / (static_cast<double>(positions.size()) * dx * dx * dx);
    std::vector<double> volumes(positions.size(), mean);
    Evening evening(region, positions, dx, origin);
    for (int sweep = 0; sweep < kSweeps; ++sweep) evening.sweep(volumes);
    for (double& v : volumes) v = std::max(v, kLeastShare * mean);
    const double scale = volume / parallelSum(volumes.size(), [&](std::size_t p) { return volumes[p]; });
    for (double& v : volumes) v *= scale;
    return volumes;
}

}  // namespace sim
