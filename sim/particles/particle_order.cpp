#include "sim/particles/particle_order.h"

#include "sim/core/check.h"
#include "sim/core/parallel.h"

#include <atomic>
#include <limits>

namespace sim {

namespace {

constexpr std::size_t kSortChunks = 32;  ///< a histogram over the blocks each
constexpr std::uint32_t kDead = std::numeric_limits<std::uint32_t>::max();

struct SortChunks {
    explicit SortChunks(std::size_t n) : total(n), size((n + kSortChunks - 1) / kSortChunks) {}
    std::size_t begin(std::size_t c) const { return std::min(total, c * size); }
    std::size_t end(std::size_t c) const { return std::min(total, (c + 1) * size); }
    std::size_t total, size;
};

/// The cell a position lies in. Kernels compute it by the same expression. False if that is out of the range of block numbers.
inline bool findCell(const Vec3& x, const Vec3& origin, double inverseDx, Vec3i& cell)
{
    for (int a = 0; a < kAxes; ++a) {
        const double c = std::floor((x[a] - origin[a]) * inverseDx);
        constexpr double kLimit = 8.0 * (BlockGrid::kMaxCoordinate - 2);
        if (!(std::abs(c) < kLimit)) return false;
        cell[a] = static_cast<int>(c);
    }
    return true;
}

/// A position without a cell is fine only where the domain deletes it.
void checkIsDeleted(const Vec3& x, const Shape* domain)
{
    if (!x.allFinite()) throw RunError("the position of a particle is not finite");
    if (domain == nullptr || !(domain->distance(x) > 0.0))
        throw RunError("a particle has left the range of block numbers; a `domain` in the scene would delete it before");
}

inline Vec3i blockOf(const Vec3i& cell) { return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3}; }

/// Is the whole block well inside the domain?
bool insideDomain(const Shape& domain, const BlockGrid& grid, const Vec3i& block)
{
    const double half = 0.5 * kBlockEdge * grid.dx;
    const Vec3 center = grid.origin + grid.dx * kBlockEdge * block.cast<double>() + Vec3::Constant(half);
    return domain.distance(center) < -std::sqrt(3.0) * half;
}

/// Keys of all particles in the blocks that exist; blocks that do not go to `strays`.
void computeKeys(const Particles& particles, const BlockGrid& grid, const Shape* domain, ParticleOrder& order)
{
    const SortChunks chunks(particles.count);
    const double inverseDx = 1.0 / grid.dx;
    order.touched.fill(0);
    parallelFor(kSortChunks, [&](std::size_t c) {
        order.strays[c].clear();
        order.dead[c].clear();
        Vec3i lastCoords = Vec3i::Constant(std::numeric_limits<int>::max());
        int block = BlockGrid::kNone;
        bool deep = true;
        for (std::size_t p = chunks.begin(c); p < chunks.end(c); ++p) {
            const Vec3 x = particles.position(p);
            Vec3i cell;
            if (!findCell(x, grid.origin, inverseDx, cell)) {
                checkIsDeleted(x, domain);
                order.key[p] = kDead;
                order.dead[c].push_back(static_cast<int>(p));
                continue;
            }
            const Vec3i coords = blockOf(cell);
            if (coords != lastCoords) {
                lastCoords = coords;
                block = grid.find(coords);
                deep = domain == nullptr || insideDomain(*domain, grid, coords);
            }
            if (!deep && domain->distance(x) > 0.0) {
                order.key[p] = kDead;
                order.dead[c].push_back(static_cast<int>(p));
                continue;
            }
            if (block == BlockGrid::kNone) {
                if (order.strays[c].empty() || order.strays[c].back() != coords) order.strays[c].push_back(coords);
                continue;
            }
            const int i = cell.x() & 7, j = cell.y() & 7, k = cell.z() & 7;
            order.key[p] = static_cast<std::uint32_t>(block) * kBlockCells + cellRank(i, j, k);
            // Or-ing bits in any order gives the same mask.
            const std::uint32_t bits = 1u << i | 1u << (8 + j) | 1u << (16 + k);
            std::atomic_ref<std::uint32_t> mask(order.touched[block]);
            if ((mask.load(std::memory_order_relaxed) & bits) != bits) mask.fetch_or(bits, std::memory_order_relaxed);
        }
    });
}

void sortUnique(std::vector<Vec3i>& coords)
{
    std::sort(coords.begin(), coords.end(),
              [](const Vec3i& a, const Vec3i& b) { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); });
    coords.erase(std::unique(coords.begin(), coords.end()), coords.end());
}

/// Give the strays' blocks a place. True if there were any: the keys must then be computed again.
bool addStrayBlocks(BlockGrid& grid, ParticleOrder& order)
{
    std::vector<Vec3i> coords;
    for (const auto& strays : order.strays) coords.insert(coords.end(), strays.begin(), strays.end());
    if (coords.empty()) return false;
    coords.insert(coords.end(), grid.coords().begin(), grid.coords().end());
    sortUnique(coords);
    grid.setBlocks(coords);
    return true;
}

/// Does a mask of 8 planes reach below the block, above it?
inline bool reachesBelow(std::uint32_t planes) { return (planes & ((1u << kReachBelow) - 1)) != 0; }
inline bool reachesAbove(std::uint32_t planes) { return (planes >> (kBlockEdge - kReachAbove) & 0xff) != 0; }

/// Call need(dx, dy, dz) for each neighbour of a touched block that must exist, itself included.
template <class Need>
void forEachNeededNeighbour(std::uint32_t touched, Need&& need)
{
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
        const std::uint32_t planes = touched >> (8 * a) & 0xff;
        low[a] = reachesBelow(planes) ? -1 : 0;
        high[a] = reachesAbove(planes) ? 1 : 0;
    }
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
            for (int x = low[0]; x <= high[0]; ++x) need(x, y, z);
}

/// Make the grid's blocks those that touched blocks need. Keeps everything as it is if that changes nothing.
void fitBlocks(BlockGrid& grid, ParticleOrder& order)
{
    std::vector<std::uint8_t>& needed = order.needed;
    std::vector<Vec3i>& missing = order.missing;
    std::vector<int>& renumbered = order.renumbered;
    needed.assign(grid.count(), 0);
    missing.clear();
    for (int b = 0; b < grid.count(); ++b) {
        if (order.touched[b] == 0) continue;
        forEachNeededNeighbour(order.touched[b], [&](int dx, int dy, int dz) {
            const int n = grid.neighbours(b)[neighbourIndex(dx, dy, dz)];
            if (n == grid.count()) missing.push_back(grid.coords(b) + Vec3i(dx, dy, dz));
            else needed[n] = 1;
        });
    }
    renumbered.clear();
    if (missing.empty() && std::find(needed.begin(), needed.end(), 0) == needed.end()) return;

    sortUnique(missing);
    const std::vector<Vec3i> old = grid.coords();
    for (int b = 0; b < static_cast<int>(old.size()); ++b)
        if (needed[b]) missing.push_back(old[b]);
    grid.setBlocks(missing);
    renumbered.resize(old.size());
    for (std::size_t b = 0; b < old.size(); ++b) renumbered[b] = needed[b] ? grid.find(old[b]) : BlockGrid::kNone;
}

/// Counting sort, first by block (chunk by chunk, so in parallel and stable), then by cell within each block.
void scatterByBlock(const Particles& particles, int blocks, ParticleOrder& order)
{
    const std::vector<int>& renumbered = order.renumbered;
    const SortChunks chunks(particles.count);
    order.histogram.resize(kSortChunks * blocks);
    parallelFor(kSortChunks, [&](std::size_t c) {
        int* count = order.histogram.data() + c * blocks;
        std::fill_n(count, blocks, 0);
        for (std::size_t p = chunks.begin(c); p < chunks.end(c); ++p) {
            std::uint32_t& key = order.key[p];
            if (key == kDead) continue;
            if (!renumbered.empty()) key = renumbered[key / kBlockCells] * kBlockCells + key % kBlockCells;
            ++count[key / kBlockCells];
        }
    });
    int running = 0;
    for (int b = 0; b < blocks; ++b) {
        order.cellStart[static_cast<std::size_t>(b) * kBlockCells] = running;
        for (std::size_t c = 0; c < kSortChunks; ++c) {
            int& count = order.histogram[c * blocks + b];
            const int start = running;
            running += count;
            count = start;
        }
    }
    order.cellStart[static_cast<std::size_t>(blocks) * kBlockCells] = running;
    parallelFor(kSortChunks, [&](std::size_t c) {
        int* next = order.histogram.data() + c * blocks;
        for (std::size_t p = chunks.begin(c); p < chunks.end(c); ++p) {
            if (order.key[p] == kDead) continue;
            const int s = next[order.key[p] / kBlockCells]++;
            order.binned[s] = static_cast<int>(p);
            order.binnedCell[s] = static_cast<std::uint16_t>(order.key[p] % kBlockCells);
        }
    });
}

void sortWithinBlock(const Particles& particles, int block, ParticleOrder& order)
{
    std::array<int, kBlockCells> next{};
    int* start = order.cellStart.data() + static_cast<std::size_t>(block) * kBlockCells;
    const int first = start[0], last = start[kBlockCells];
    for (int s = first; s < last; ++s) ++next[order.binnedCell[s]];
    // start[0] stays as it is, which the block before reads for its end.
    int running = first;
    for (int c = 0; c < kBlockCells; ++c) {
        const int here = running;
        running += next[c];
        next[c] = here;
        if (c > 0) start[c] = here;
    }
    for (int s = first; s < last; ++s) {
        const int to = next[order.binnedCell[s]]++, from = order.binned[s];
        order.source[to] = from;
        for (int a = 0; a < kAxes; ++a) order.x[a][to] = particles.x[a][from];
        order.mass[to] = particles.mass[from];
        order.id[to] = particles.id[from];
    }
}

void recordDeaths(const Particles& particles, const ParticleOrder& order, Ledger& ledger)
{
    for (const auto& chunk : order.dead)
        for (int p : chunk) {
            ledger.leftMass += particles.mass[p];
            ledger.leftMomentum += particles.mass[p] * particles.velocity(p);
        }
}

void listBlocks(const BlockGrid& grid, ParticleOrder& order)
{
    order.occupied.clear();
    order.maxParticlesPerBlock = 0;
    for (auto& color : order.byColor) color.clear();
    for (int b = 0; b < grid.count(); ++b) {
        if (order.size(b) == 0) continue;
        const Vec3i& c = grid.coords(b);
        order.occupied.push_back(b);
        order.byColor[(c.x() & 1) | (c.y() & 1) << 1 | (c.z() & 1) << 2].push_back(b);
        order.maxParticlesPerBlock = std::max<std::size_t>(order.maxParticlesPerBlock, order.size(b));
    }
    const auto fuller = [&](int a, int b) { return std::pair(-order.size(a), a) < std::pair(-order.size(b), b); };
    for (auto& color : order.byColor) std::sort(color.begin(), color.end(), fuller);
}

}  // namespace

void sortParticles(Particles& particles, BlockGrid& grid, const Shape* domain, ParticleOrder& order, Ledger* ledger)
{
    SIM_CHECK(domain == nullptr || ledger != nullptr);
    const std::size_t n = particles.count, padded = particles.mass.size();
    if (n > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 2) throw RunError("more than 10^9 particles");
    order.strays.resize(kSortChunks);
    order.dead.resize(kSortChunks);
    order.key.resize(n);

    order.before.assign(grid.coords().begin(), grid.coords().end());
    do {
        order.touched.resize(grid.count());
        computeKeys(particles, grid, domain, order);
    } while (addStrayBlocks(grid, order));
    if (ledger != nullptr) recordDeaths(particles, order, *ledger);

    fitBlocks(grid, order);

    order.cellStart.resize(static_cast<std::size_t>(grid.count()) * kBlockCells + 1);
    order.binned.resize(n);
    order.binnedCell.resize(n);
    order.source.resize(padded);
    for (auto& x : order.x) x.resize(padded);
    order.mass.resize(padded);
    order.id.resize(padded);
    scatterByBlock(particles, grid.count(), order);
    parallelFor(grid.count(), [&](std::size_t b) { sortWithinBlock(particles, static_cast<int>(b), order); });

    particles.count = order.cellStart[static_cast<std::size_t>(grid.count()) * kBlockCells];
    for (int a = 0; a < kAxes; ++a) particles.x[a].swap(order.x[a]);
    particles.mass.swap(order.mass);
    particles.id.swap(order.id);
    listBlocks(grid, order);

    order.blocksChanged = order.before != grid.coords();
    order.previous.assign(grid.count(), BlockGrid::kNone);
    for (int old = 0; old < static_cast<int>(order.before.size()); ++old) {
        const int b = order.blocksChanged ? grid.find(order.before[old]) : old;
        if (b != BlockGrid::kNone) order.previous[b] = old;
    }
}

}  // namespace sim
