#include "sim/coupling/capture.h"

#include "sim/core/parallel.h"
#include "sim/coupling/cell_stencil.h"

#include <algorithm>

namespace sim {

namespace {

constexpr double kLeastShare = 1.0e-3;  ///< of the nominal mass, below which a particle gives all it has (model-fluid 9.1) [-]

/// body(block) for all blocks of an order, those of a colour in parallel: bodies of the same colour reach no common cell.
template <class Body>
void forEachColored(const ParticleOrder& order, Body&& body)
{
    for (const std::vector<int>& blocks : order.byColor) parallelFor(blocks.size(), [&](std::size_t n) { body(blocks[n]); });
}

}  // namespace

Capture::Capture(const Fabric& fabric, const Settings& settings, double nominalMass)
    : fabric_(fabric), leastMass_(kLeastShare * nominalMass)
{
    const CaptureSettings& capture = settings.coupling.capture;
    std::vector<double> rates;  // of each material [1/s]
    for (const FabricMaterial& m : fabric.materials) {
        const PorousLaw law({settings.porous.fibreDiameter, m.volumeFraction}, settings.liquid, settings.coupling);
        rates.push_back(m.volumeFraction < 1.0 ? capture.compatFactor * capture.rate * law.captureRate(m.volumeFraction, settings.cell) : 0.0);
    }
    for (std::size_t v = 0; v < fabric.vertexCount(); ++v) {
        capacity_.push_back(poreVolume(fabric, v) * settings.liquid.density);
        ratePerVertex_.push_back(rates[fabric.vertexMaterial[v]]);
    }
    wanted_.resize(fabric.vertexCount());
    around_.resize(fabric.vertexCount());
    toPins_.resize(fabric.vertexCount());
}

/// body(vertices' block, vertex, stencil) for the vertices that have room.
template <class Body>
void Capture::forEachThirsty(const SortedVertices& vertices, Body&& body) const
{
    forEachColored(vertices.order, [&](int block) {
        if (!thirsty_[block]) return;
        const Vec3 corner = vertices.grid.lowerCorner(block);
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
            const std::size_t v = vertices.particles.id[s];
            if (wanted_[v] > 0.0) body(block, v, CellStencil(vertices.particles.position(s), corner, vertices.grid.dx));
        }
    });
}

/// body(liquid's block, particle, stencil) for the particles whose stencils may reach cells that thirsty vertices reach.
template <class Body>
void Capture::forEachNear(const BlockGrid& grid, const ParticleOrder& order, const LiquidParticles& liquid, Body&& body) const
{
    forEachColored(order, [&](int block) {
        if (!isNear_[block]) return;
        const Vec3 corner = grid.lowerCorner(block);
        for (int s = order.begin(block); s < order.end(block); ++s)
            body(block, static_cast<std::size_t>(s), CellStencil(liquid.position(s), corner, grid.dx));
    });
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

    cells_.resize(blocks);
    reached_.resize(blocks);
    parallelFor(blocks, [&](std::size_t b) {
        std::fill_n(cells_.block(static_cast<int>(b)), kKinds * kBlockCells, 0.0);
        std::fill_n(reached_.block(static_cast<int>(b)), kBlockCells, std::uint8_t{0});
    });
    forEachThirsty(vertices, [&](int block, std::size_t, const CellStencil& stencil) {
        stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double) { reached_.block(b)[c] = 1; });
    });
    blockReached_.assign(blocks + 1, 0);
    parallelFor(blocks, [&](std::size_t b) {
        const std::uint8_t* cells = reached_.block(static_cast<int>(b));
        blockReached_[b] = std::find(cells, cells + kBlockCells, 1) != cells + kBlockCells;
    });
    return true;
}

/// Which blocks of the liquid lie at cells that are reached?
bool Capture::matchBlocks(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices)
{
    nearBlocks_.resize(grid.count());
    isNear_.assign(grid.count(), 0);
    parallelFor(order.occupied.size(), 16, [&](std::size_t n) {
        const int block = order.occupied[n];
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const int at = vertices.grid.find(grid.coords(block) + Vec3i(x, y, z));
                    const int known = at == BlockGrid::kNone ? vertices.grid.count() : at;
                    nearBlocks_[block][neighbourIndex(x, y, z)] = known;
                    if (blockReached_[known]) isNear_[block] = 1;
                }
    });
    return std::find(isNear_.begin(), isNear_.end(), 1) != isNear_.end();
}

/// Mass and momentum of the liquid in the cells that are reached.
void Capture::collect(const BlockGrid& grid, const ParticleOrder& order, const LiquidParticles& liquid)
{
    forEachNear(grid, order, liquid, [&](int block, std::size_t p, const CellStencil& stencil) {
        const Vec3 v = liquid.velocity(order.source[p]);
        const double mass = liquid.mass[p];
        stencil.forEach(nearBlocks_[block], [&](int b, int c, double weight) {
            if (!reached_.block(b)[c]) return;
            double* cell = cells_.block(b) + c;
            cell[kMass * kBlockCells] += weight * mass;
            for (int a = 0; a < kAxes; ++a) cell[(kMomentum + a) * kBlockCells] += weight * mass * v[a];
        });
    });
}

/// What each vertex wants, and of which cells: in proportion to what it sees of them.
void Capture::ask(double dt, const SortedVertices& vertices, const FabricState& state)
{
    forEachThirsty(vertices, [&](int block, std::size_t v, const CellStencil& stencil) {
        const std::array<int, 27>& blocks = vertices.grid.neighbours(block);
        double around = 0.0;
        stencil.forEach(blocks, [&](int b, int c, double weight) { around += weight * cells_.block(b, kMass)[c]; });
        around_[v] = around;
        wanted_[v] = std::min(roomOf(v, state), around * std::min(1.0, ratePerVertex_[v] * dt));
        if (!(around > 0.0)) return;
        stencil.forEach(blocks, [&](int b, int c, double weight) {
            cells_.block(b, kDemand)[c] += wanted_[v] / around * weight * cells_.block(b, kMass)[c];
        });
    });
}

/// No cell gives more than it has: demands become shares of the cells' liquid, at most 1 …
void Capture::settle(const SortedVertices& vertices)
{
    parallelFor(vertices.grid.count(), 8, [&](std::size_t n) {
        const double* mass = cells_.block(static_cast<int>(n), kMass);
        double* demand = cells_.block(static_cast<int>(n), kDemand);
        for (int c = 0; c < kBlockCells; ++c) demand[c] = mass[c] > 0.0 ? demand[c] / mass[c] : 0.0;
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
    forEachThirsty(vertices, [&](int block, std::size_t v, const CellStencil& stencil) {
        if (!(around_[v] > 0.0)) return;
        double mass = 0.0;
        Vec3 momentum = Vec3::Zero();
        stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
            const double* cell = cells_.block(b) + c;
            if (!(cell[kMass * kBlockCells] > 0.0)) return;
            // Of what is asked of the cell it gives all, or as much as it has.
            const double share = wanted_[v] / around_[v] * weight / std::max(1.0, cell[kDemand * kBlockCells]);
            mass += share * cell[kMass * kBlockCells];
            for (int a = 0; a < kAxes; ++a) momentum[a] += share * cell[(kMomentum + a) * kBlockCells];
        });
        around_[v] = mass;  // now: what it got
        give(v, mass, momentum, state);
    });
    return parallelSum(around_.size(), [&](std::size_t v) { return around_[v]; });
}

/// Particles give what the cells around them gave.
void Capture::drain(const BlockGrid& grid, const ParticleOrder& order, LiquidParticles& liquid)
{
    forEachNear(grid, order, liquid, [&](int block, std::size_t p, const CellStencil& stencil) {
        double share = 0.0;
        stencil.forEach(nearBlocks_[block], [&](int b, int c, double weight) { share += weight * std::min(1.0, cells_.block(b, kDemand)[c]); });
        liquid.mass[p] *= std::max(0.0, 1.0 - share);
    });
}

/// Particles that are hardly there any more go to the nearest vertex with room; few ever are.
double Capture::takeRemnants(const BlockGrid& grid, const ParticleOrder& order, const SortedVertices& vertices, LiquidParticles& liquid,
                             FabricState& state)
{
    double sum = 0.0;
    for (int block : order.occupied) {
        if (!isNear_[block]) continue;
        for (int s = order.begin(block); s < order.end(block); ++s) {
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
    if (!findThirsty(vertices, state) || !matchBlocks(grid, order, vertices)) return 0.0;
    collect(grid, order, liquid);
    ask(dt, vertices, state);
    settle(vertices);
    const double mass = wet(vertices, state);
    drain(grid, order, liquid);
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
