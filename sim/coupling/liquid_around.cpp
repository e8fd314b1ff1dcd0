#include "sim/coupling/liquid_around.h"

#include <limits>

namespace sim {

namespace {

constexpr int kParticlesPerPart = 1024;
constexpr double kSmear = 1.7;  ///< over which room at a wall grows from none to all, as what a particle brings to cells does [cells]

}  // namespace

/// The cells that the vertices reach, empty.
void LiquidAround::findReached(const SortedVertices& vertices)
{
    const int blocks = vertices.grid.count();
    cells_.resize((static_cast<std::size_t>(blocks) + 1) * kBlockCells * kLanes);
    reached_.resize(blocks);
    std::fill_n(&cell(blocks, 0), kBlockCells, Pack{});
    parallelFor(blocks, [&](std::size_t b) {
        std::fill_n(&cell(static_cast<int>(b), 0), kBlockCells, Pack{});
        std::fill_n(reached_.block(static_cast<int>(b)), kBlockCells, std::uint8_t{0});
    });
    forEachColored(vertices.order, [&](int block) {
        const Vec3 corner = vertices.grid.lowerCorner(block);
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s)
            CellStencil(vertices.particles.position(s), corner, vertices.grid.dx).forEach(vertices.grid.neighbours(block), [&](int b, int c, double) {
                reached_.block(b)[c] = 1;
            });
    });
    blockReached_.assign(blocks + 1, 0);
    parallelFor(blocks, [&](std::size_t b) {
        const std::uint8_t* cells = reached_.block(static_cast<int>(b));
        blockReached_[b] = std::find(cells, cells + kBlockCells, 1) != cells + kBlockCells;
    });
}

/// The cells of a block with a cell around them that is reached; `blocks`: the 27 around it.
LiquidAround::CellMask LiquidAround::cellsNear(const std::array<int, 27>& blocks) const
{
    constexpr int kEdge = CellStencil::kTileEdge;
    // Of each column of a tile along z, whether its cells are reached: a bit each.
    std::array<std::uint32_t, kEdge * kEdge> columns{};
    for (int j = -1; j <= kBlockEdge; ++j)
        for (int i = -1; i <= kBlockEdge; ++i)
            for (int k = -1; k <= kBlockEdge; ++k) {
                const int b = blocks[neighbourIndex(i >> 3, j >> 3, k >> 3)];
                if (blockReached_[b] && reached_.block(b)[cellInBlock(i & 7, j & 7, k & 7)]) columns[(i + 1) * kEdge + j + 1] |= 1u << (k + 1);
            }
    CellMask cells{};
    for (int i = 0; i < kBlockEdge; ++i)
        for (int j = 0; j < kBlockEdge; ++j) {
            std::uint32_t around = 0;
            for (int x = 0; x < 3; ++x)
                for (int y = 0; y < 3; ++y) around |= columns[(i + x) * kEdge + j + y];
            const std::uint64_t column = (around | around >> 1 | around >> 2) & 0xffu;
            cells[cellRank(i, j, 0) / 64] |= column << cellRank(i, j, 0) % 64;
        }
    return cells;
}

/// The particles in blocks that lie at cells that are reached, in parts of similar size.
bool LiquidAround::findNear(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices)
{
    nearBlocks_.resize(grid.count());
    nearBegin_.clear();
    near_.clear();
    for (int block = 0; block < grid.count(); ++block) {
        nearBegin_.push_back(static_cast<int>(near_.size()));
        if (order.begin(block) == order.end(block)) continue;
        bool isNear = false;
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const int at = vertices.grid.find(grid.coords(block) + Vec3i(x, y, z));
                    const int known = at == BlockGrid::kNone ? vertices.grid.count() : at;
                    nearBlocks_[block][neighbourIndex(x, y, z)] = known;
                    if (blockReached_[known]) isNear = true;
                }
        if (!isNear) continue;
        const CellMask cells = cellsNear(nearBlocks_[block]);
        if (std::ranges::all_of(cells, [](std::uint64_t word) { return word == 0; })) continue;
        for (int s = order.begin(block); s < order.end(block); s += kParticlesPerPart)
            near_.push_back({block, s, std::min(s + kParticlesPerPart, order.end(block)), cells});
    }
    nearBegin_.push_back(static_cast<int>(near_.size()));
    return !near_.empty();
}

/// What a tile has of the cells that are reached; `blocks`: the 27 around the tile's.
void LiquidAround::addTile(const Pack* tile, const std::array<int, 27>& blocks)
{
    constexpr int kEdge = CellStencil::kTileEdge;
    for (int k = 0; k < kEdge; ++k)
        for (int j = 0; j < kEdge; ++j)
            for (int i = 0; i < kEdge; ++i) {
                const int x = i - 1, y = j - 1, z = k - 1;
                const int b = blocks[neighbourIndex(x >> 3, y >> 3, z >> 3)], c = cellInBlock(x & 7, y & 7, z & 7);
                if (reached_.block(b)[c]) cell(b, c) += tile[(k * kEdge + j) * kEdge + i];
            }
}

/// Liquid in the cells that are reached.
void LiquidAround::collect(const SortedParticles& sorted)
{
    const Particles& liquid = sorted.particles;
    const ParticleOrder& order = sorted.order;
    const BlockGrid& grid = sorted.grid;
    constexpr int kTile = CellStencil::kTileEdge * CellStencil::kTileEdge * CellStencil::kTileEdge;
    tiles_.resize(near_.size() * kTile * kLanes);
    const auto tileOf = [&](std::size_t part) { return reinterpret_cast<Pack*>(tiles_.data()) + part * kTile; };
    parallelFor(near_.size(), [&](std::size_t part) {
        Pack* tile = tileOf(part);
        std::fill_n(tile, kTile, Pack{});
        const Vec3 corner = grid.lowerCorner(near_[part].block);
        forEachParticle(order, near_[part], [&](int p) {
            const Vec3 v = liquid.velocity(order.source[p]), x = liquid.position(p);
            const double mass = liquid.mass[p];
            const Pack all = {mass, mass * v.x(), mass * v.y(), mass * v.z(), mass * x.x(), mass * x.y(), mass * x.z()};
            CellStencil(x, corner, grid.dx).forEachInTile([&](int place, double weight) { tile[place] += weight * all; });
        });
    });
    forEachColored(order, [&](int block) {
        for (int part = nearBegin_[block]; part < nearBegin_[block + 1]; ++part) addTile(tileOf(part), nearBlocks_[block]);
    });
}

/// Mean place of the room outside solids that a point sees, against the point [cells].
Vec3 LiquidAround::centroidOfRoom(const ObstacleField& obstacles, const SortedVertices& vertices, int block, const CellStencil& stencil,
                                  const Vec3& x) const
{
    const BlockGrid& grid = vertices.grid;
    const std::array<int, 27>& around = grid.neighbours(block);
    if (std::ranges::all_of(around, [&](int b) { return b == grid.count() || solidBlock_[b] == BlockGrid::kNone; })) return Vec3::Zero();
    double all = 0.0;
    Vec3 moment = Vec3::Zero();
    const Vec3 middle = (grid.lowerCorner(block) - x) / grid.dx + Vec3(stencil.cell[0], stencil.cell[1], stencil.cell[2]) + Vec3::Constant(0.5);
    int n = 0;
    stencil.forEach(around, [&](int b, int c, double weight) {
        const Vec3 at = middle + Vec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        ++n;
        const int solid = b == grid.count() ? BlockGrid::kNone : solidBlock_[b];
        const double room = solid == BlockGrid::kNone ? 1.0 : std::clamp(0.5 + obstacles.centerDistance(solid)[c] / (kSmear * grid.dx), 0.0, 1.0);
        all += weight * room;
        moment += weight * room * at;
    });
    // Twice: this is of the cells' middles, and not of what is in them as the liquid's is.
    return all > 0.0 ? Vec3(2.0 / all * moment) : Vec3::Zero().eval();
}

/// What each vertex sees of it.
void LiquidAround::sampleAtVertices(const BlockGrid& grid, const ObstacleField& obstacles, const SortedVertices& vertices)
{
    solidBlock_.resize(vertices.grid.count());
    for (int b = 0; b < vertices.grid.count(); ++b) {
        const int liquid = grid.find(vertices.grid.coords(b));
        solidBlock_[b] = liquid != BlockGrid::kNone && obstacles.nearSolid(liquid) ? liquid : BlockGrid::kNone;
    }
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        const Vec3 corner = vertices.grid.lowerCorner(block);
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
            const Vec3 x = vertices.particles.position(s);
            Pack sum{};
            const CellStencil stencil(x, corner, vertices.grid.dx);
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) { sum += weight * cell(b, c); });
            const std::size_t v = vertices.particles.id[s];
            mass_[v] = sum[kMass];
            distance_[v] = std::numeric_limits<double>::infinity();
            if (!(mass_[v] > 0.0)) continue;
            const Vec3 middle = Vec3(sum[kMoment], sum[kMoment + 1], sum[kMoment + 2]) / mass_[v];
            distance_[v] = ((middle - x) / vertices.grid.dx - centroidOfRoom(obstacles, vertices, block, stencil, x)).norm();
        }
    });
}

std::optional<LiquidAround::Found> LiquidAround::find(const SortedParticles& liquid, const ObstacleField& obstacles, const SortedVertices& vertices)
{
    findReached(vertices);
    if (!findNear(liquid.grid, liquid.order, vertices)) return std::nullopt;
    collect(liquid);
    sampleAtVertices(liquid.grid, obstacles, vertices);
    return Found(*this, liquid, vertices);
}

}  // namespace sim
