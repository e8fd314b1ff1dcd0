#include "sim/coupling/capture.h"

#include "sim/core/parallel.h"
#include "sim/coupling/cell_stencil.h"

#include <algorithm>

namespace sim {

namespace {

constexpr int kParticlesPerPart = 1024;
constexpr double kLeastShare = 1.0e-3;  ///< of the nominal mass, below which a particle gives all it has (model-fluid 9.1) [-]

/// body(block) for all blocks of an order that hold something, those of a colour in parallel: they reach no common cell.
template <class Body>
void forEachColored(const ParticleOrder& order, Body&& body)
{
    for (const std::vector<int>& blocks : order.byColor) parallelFor(blocks.size(), [&](std::size_t n) { body(blocks[n]); });
}

}  // namespace

Capture::Capture(const Fabric& fabric, const Settings& settings, double nominalMass)
    : fabric_(fabric), capacity_(poreCapacity(fabric, settings.liquid.density)), leastMass_(kLeastShare * nominalMass)
{
    const CaptureSettings& capture = settings.coupling.capture;
    std::vector<double> rates;  // of each material [1/s]
    for (const FabricMaterial& m : fabric.materials) {
        const PorousLaw law({settings.porous.fibreDiameter, m.volumeFraction}, settings.liquid, settings.coupling);
        rates.push_back(m.volumeFraction < 1.0 ? capture.compatFactor * capture.rate * law.captureRate(m.volumeFraction, settings.cell) : 0.0);
    }
    for (int m : fabric.vertexMaterial) ratePerVertex_.push_back(rates[m]);
    wanted_.resize(fabric.vertexCount());
    around_.resize(fabric.vertexCount());
    toPins_.resize(fabric.vertexCount());
}

/// body(vertex, stencil) for the vertices of a block that have room.
template <class Body>
void Capture::forEachThirsty(const SortedVertices& vertices, int block, Body&& body) const
{
    if (!thirsty_[block]) return;
    const Vec3 corner = vertices.grid.lowerCorner(block);
    for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
        const std::size_t v = vertices.particles.id[s];
        if (wanted_[v] > 0.0) body(v, CellStencil(vertices.particles.position(s), corner, vertices.grid.dx));
    }
}

/// body(particle, stencil) for the particles of a part.
template <class Body>
void Capture::forEachNear(const BlockGrid& grid, const LiquidParticles& liquid, std::size_t part, Body&& body) const
{
    const auto [block, begin, end] = near_[part];
    const Vec3 corner = grid.lowerCorner(block);
    for (int s = begin; s < end; ++s) body(static_cast<std::size_t>(s), CellStencil(liquid.position(s), corner, grid.dx));
}

/// The vertices that have room, and the cells that they reach. wanted_ is that room for now.
bool Capture::findThirsty(const SortedVertices& vertices, const FabricState& state)
{
    const int blocks = vertices.grid.count();
    thirsty_.assign(blocks, 0);
    std::ranges::fill(wanted_, 0.0);
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
            const std::size_t v = vertices.particles.id[s];
            wanted_[v] = ratePerVertex_[v] > 0.0 ? std::max(roomOf(v, state), 0.0) : 0.0;
            if (wanted_[v] > 0.0) thirsty_[block] = 1;
        }
    });
    if (std::find(thirsty_.begin(), thirsty_.end(), 1) == thirsty_.end()) return false;

    cells_.resize((static_cast<std::size_t>(blocks) + 1) * kBlockCells * kLanes);
    reached_.resize(blocks);
    std::fill_n(&cellOf(blocks, 0), kBlockCells, Pack{});
    parallelFor(blocks, [&](std::size_t b) {
        std::fill_n(&cellOf(static_cast<int>(b), 0), kBlockCells, Pack{});
        std::fill_n(reached_.block(static_cast<int>(b)), kBlockCells, std::uint8_t{0});
    });
    forEachColored(vertices.order, [&](int block) {
        forEachThirsty(vertices, block, [&](std::size_t, const CellStencil& stencil) {
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double) { reached_.block(b)[c] = 1; });
        });
    });
    blockReached_.assign(blocks + 1, 0);
    parallelFor(blocks, [&](std::size_t b) {
        const std::uint8_t* cells = reached_.block(static_cast<int>(b));
        blockReached_[b] = std::find(cells, cells + kBlockCells, 1) != cells + kBlockCells;
    });
    return true;
}

/// The particles in blocks that lie at cells that are reached, in parts of similar size.
bool Capture::findNear(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices)
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
        for (int s = order.begin(block); s < order.end(block); s += kParticlesPerPart)
            near_.push_back({block, s, std::min(s + kParticlesPerPart, order.end(block))});
    }
    nearBegin_.push_back(static_cast<int>(near_.size()));
    return !near_.empty();
}

/// What a tile has of the cells that are reached; `blocks`: the 27 around the tile's.
void Capture::addTile(const Pack* tile, const std::array<int, 27>& blocks)
{
    constexpr int kEdge = CellStencil::kTileEdge;
    for (int k = 0; k < kEdge; ++k)
        for (int j = 0; j < kEdge; ++j)
            for (int i = 0; i < kEdge; ++i) {
                const int x = i - 1, y = j - 1, z = k - 1;
                const int b = blocks[neighbourIndex(x >> 3, y >> 3, z >> 3)], c = cellInBlock(x & 7, y & 7, z & 7);
                if (reached_.block(b)[c]) cellOf(b, c) += tile[(k * kEdge + j) * kEdge + i];
            }
}

/// Mass and momentum of the liquid in the cells that are reached.
void Capture::collect(const BlockGrid& grid, const ParticleOrder& order, const LiquidParticles& liquid)
{
    constexpr int kTile = CellStencil::kTileEdge * CellStencil::kTileEdge * CellStencil::kTileEdge;
    tiles_.resize(near_.size() * kTile * kLanes);
    const auto tileOf = [&](std::size_t part) { return reinterpret_cast<Pack*>(tiles_.data()) + part * kTile; };
    parallelFor(near_.size(), [&](std::size_t part) {
        Pack* tile = tileOf(part);
        std::fill_n(tile, kTile, Pack{});
        forEachNear(grid, liquid, part, [&](std::size_t p, const CellStencil& stencil) {
            const Vec3 v = liquid.velocity(order.source[p]);
            const double mass = liquid.mass[p];
            const Pack all = {mass, mass * v.x(), mass * v.y(), mass * v.z()};
            stencil.forEachInTile([&](int place, double weight) { tile[place] += weight * all; });
        });
    });
    forEachColored(order, [&](int block) {
        for (int part = nearBegin_[block]; part < nearBegin_[block + 1]; ++part) addTile(tileOf(part), nearBlocks_[block]);
    });
}

/// What each vertex wants, and of which cells: in proportion to what it sees of them.
void Capture::ask(double dt, const SortedVertices& vertices, const FabricState& state)
{
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        forEachThirsty(vertices, block, [&](std::size_t v, const CellStencil& stencil) {
            double around = 0.0;
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) { around += weight * cellOf(b, c)[kMass]; });
            around_[v] = around;
            wanted_[v] = std::min(roomOf(v, state), around * std::min(1.0, ratePerVertex_[v] * dt));
        });
    });
    forEachColored(vertices.order, [&](int block) {
        forEachThirsty(vertices, block, [&](std::size_t v, const CellStencil& stencil) {
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
                cellOf(b, c)[kDemand] += wanted_[v] / around_[v] * weight * cellOf(b, c)[kMass];
            });
        });
    });
}

/// No cell gives more than it has: demands become shares of the cells' liquid, at most 1 …
void Capture::settle(const SortedVertices& vertices)
{
    parallelFor(vertices.grid.count(), 8, [&](std::size_t n) {
        for (int c = 0; c < kBlockCells; ++c) {
            Pack& cell = cellOf(static_cast<int>(n), c);
            cell[kDemand] = cell[kMass] > 0.0 ? cell[kDemand] / cell[kMass] : 0.0;
        }
    });
}

/// Liquid that comes to a vertex with its momentum.
void Capture::give(std::size_t v, double mass, const Vec3& momentum, FabricState& state)
{
    const double before = fabric_.mass[v] + state.absorbed[v];
    state.absorbed[v] += mass;
    if (fabric_.pinned[v]) toPins_[v] += momentum - mass * state.v[v];
    else state.v[v] = (before * state.v[v] + momentum) / (before + mass);
}

double Capture::wet(const SortedVertices& vertices, FabricState& state)
{
    parallelFor(around_.size(), 4096, [&](std::size_t v) {
        if (!(wanted_[v] > 0.0)) around_[v] = 0.0;
    });
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        forEachThirsty(vertices, block, [&](std::size_t v, const CellStencil& stencil) {
            Pack got{};
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
                const Pack& cell = cellOf(b, c);
                // Of what is asked of the cell it gives all, or as much as it has.
                if (cell[kMass] > 0.0) got += wanted_[v] / around_[v] * weight / std::max(1.0, cell[kDemand]) * cell;
            });
            around_[v] = got[kMass];  // now: what it got
            give(v, got[kMass], {got[kMomentum], got[kMomentum + 1], got[kMomentum + 2]}, state);
        });
    });
    return parallelSum(around_.size(), [&](std::size_t v) { return around_[v]; });
}

/// Particles give what the cells around them gave.
void Capture::drain(const BlockGrid& grid, LiquidParticles& liquid)
{
    parallelFor(near_.size(), [&](std::size_t part) {
        const std::array<int, 27>& blocks = nearBlocks_[near_[part].block];
        forEachNear(grid, liquid, part, [&](std::size_t p, const CellStencil& stencil) {
            double share = 0.0;
            stencil.forEach(blocks, [&](int b, int c, double weight) { share += weight * std::min(1.0, cellOf(b, c)[kDemand]); });
            liquid.mass[p] *= std::max(0.0, 1.0 - share);
        });
    });
}

/// Particles that are hardly there any more go to the nearest vertex with room; few ever are.
double Capture::takeRemnants(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices, LiquidParticles& liquid,
                             FabricState& state)
{
    double sum = 0.0;
    for (const auto& [block, begin, end] : near_) {
        for (int s = begin; s < end; ++s) {
            if (liquid.mass[s] >= leastMass_) continue;
            if (liquid.mass[s] == 0.0) {
                emptied_.push_back(s);
                continue;
            }
            const Vec3 x = liquid.position(s);
            double nearest = 2.25 * grid.dx * grid.dx;  // 1.5 cells: a stencil
            std::size_t taker = fabric_.vertexCount();
            for (int b : nearBlocks_[block]) {
                if (b == vertices.grid.count()) continue;
                for (int n = vertices.order.begin(b); n < vertices.order.end(b); ++n) {
                    const std::size_t v = vertices.particles.id[n];
                    const double distance = (vertices.particles.position(n) - x).squaredNorm();
                    if (distance < nearest && roomOf(v, state) > 0.0) nearest = distance, taker = v;
                }
            }
            if (taker == fabric_.vertexCount()) continue;
            const double mass = liquid.mass[s];
            give(taker, mass, mass * liquid.velocity(order.source[s]), state);
            sum += mass;
            liquid.mass[s] = 0.0;
            emptied_.push_back(s);
        }
    }
    return sum;
}

double Capture::capture(double dt, const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices, LiquidParticles& liquid,
                        FabricState& state)
{
    emptied_.clear();
    std::ranges::fill(toPins_, Vec3::Zero());
    if (!findThirsty(vertices, state) || !findNear(grid, order, vertices)) return 0.0;
    collect(grid, order, liquid);
    ask(dt, vertices, state);
    settle(vertices);
    const double mass = wet(vertices, state);
    drain(grid, liquid);
    return mass + takeRemnants(grid, order, vertices, liquid, state);
}

void Capture::dropEmptied(LiquidParticles& liquid)
{
    for (std::size_t n = emptied_.size(); n-- > 0;) {
        if (emptied_[n] != liquid.count - 1) liquid.copy(liquid.count - 1, emptied_[n]);
        liquid.resize(liquid.count - 1);
    }
    emptied_.clear();
}

}  // namespace sim
