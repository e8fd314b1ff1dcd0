#include "sim/coupling/capture.h"

#include "sim/core/parallel.h"
#include "sim/coupling/cell_stencil.h"

#include <algorithm>
#include <cmath>

namespace sim {

namespace {

/// Distances (LiquidAround::Found) up to which fabric takes up liquid at its rate, and from which on none [cells]. Of those tried from 0.63 to 1 the
/// pair by which a drop loses the same to cloth at cells of 0.35 to 0.125 (MeshIndependence.UptakeOfCloth).
constexpr double kFullUptake = 0.73, kNoUptake = 0.9;
constexpr double kLeastShare = 1.0e-3;  ///< share of the nominal mass below which a particle gives all it has (coupling/README.md, Uptake) [-]

}  // namespace

Capture::Capture(const Fabric& fabric, const Settings& settings, double nominalMass)
    : fabric_(fabric),
      capacity_(poreCapacity(fabric, settings.liquid.density)),
      law_(settings.coupling.capture.law),
      leastMass_(kLeastShare * nominalMass)
{
    const bool isWetting = std::cos(settings.liquid.contactAngle) > 0.0 && settings.coupling.capture.rate > 0.0;
    std::vector<double> rates;  // of each material [1/s]
    for (const FabricMaterial& m : fabric.materials) rates.push_back(isWetting && m.volumeFraction < 1.0 ? rateOf(m, settings) : 0.0);
    for (int m : fabric.vertexMaterial) ratePerVertex_.push_back(rates[m]);
    wanted_.resize(fabric.vertexCount());
    got_.resize(fabric.vertexCount());
    pinImpulse_.resize(fabric.vertexCount());
}

double Capture::rateOf(const FabricMaterial& material, const Settings& settings)
{
    const CaptureSettings& capture = settings.coupling.capture;
    if (capture.law == CaptureLaw::Fabric) return capture.rate;
    const PorousLaw law({settings.porous.fibreDiameter, material.volumeFraction}, settings.liquid, settings.coupling);
    return capture.publishedRateFactor * law.captureRate(material.volumeFraction, settings.cell);
}

/// What a vertex would take of the liquid around it [g].
double Capture::demand(std::size_t v, double dt, const Around& around) const
{
    const double share = std::min(1.0, ratePerVertex_[v] * dt);
    if (law_ == CaptureLaw::Published) return share * around.massAt(v);
    return around.massAt(v) > 0.0 ? share * capacity_[v] * wettedPart(around.distanceAt(v), kFullUptake, kNoUptake) : 0.0;
}

/// body(vertex, stencil) for the vertices of a block that have room.
template <class Body>
void Capture::forEachUnsaturated(const SortedVertices& vertices, int block, Body&& body) const
{
    if (!hasUnsaturated_[block]) return;
    const Vec3 corner = vertices.grid.lowerCorner(block);
    for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
        const std::size_t v = vertices.particles.id[s];
        if (wanted_[v] > 0.0) body(v, CellStencil(vertices.particles.position(s), corner, vertices.grid.dx));
    }
}

/// The vertices that have room. wanted_ is that room for now.
bool Capture::findUnsaturatedVertices(const SortedVertices& vertices, const FabricState& state)
{
    hasUnsaturated_.assign(vertices.grid.count(), 0);
    std::ranges::fill(wanted_, 0.0);
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        for (int s = vertices.order.begin(block); s < vertices.order.end(block); ++s) {
            const std::size_t v = vertices.particles.id[s];
            wanted_[v] = ratePerVertex_[v] > 0.0 ? std::max(roomOf(v, state), 0.0) : 0.0;
            if (wanted_[v] > 0.0) hasUnsaturated_[block] = 1;
        }
    });
    return std::find(hasUnsaturated_.begin(), hasUnsaturated_.end(), 1) != hasUnsaturated_.end();
}

/// What each vertex wants, and of which cells: in proportion to what it sees of them.
void Capture::computeDemand(double dt, const Around& around)
{
    const SortedVertices& vertices = around.vertices();
    parallelFor(wanted_.size(), 4096, [&](std::size_t v) {
        if (wanted_[v] > 0.0) wanted_[v] = std::min(wanted_[v], demand(v, dt, around));
    });
    asked_.resize(vertices.grid.count());
    parallelFor(vertices.grid.count(), 8, [&](std::size_t b) { std::fill_n(asked_.block(static_cast<int>(b)), kBlockCells, 0.0); });
    forEachColored(vertices.order, [&](int block) {
        forEachUnsaturated(vertices, block, [&](std::size_t v, const CellStencil& stencil) {
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
                asked_.block(b)[c] += wanted_[v] / around.massAt(v) * weight * around.cell(b, c)[LiquidAround::kMass];
            });
        });
    });
}

/// Which share of its liquid is asked of each cell. It gives no more than it has: where the share is more than 1, each vertex gets its part of all.
void Capture::findShares(const Around& around)
{
    const SortedVertices& vertices = around.vertices();
    isAsked_.assign(vertices.grid.count() + 1, 0);
    share_.resize(vertices.grid.count());
    parallelFor(vertices.grid.count(), 8, [&](std::size_t n) {
        const int b = static_cast<int>(n);
        for (int c = 0; c < kBlockCells; ++c) {
            const double mass = around.cell(b, c)[LiquidAround::kMass];
            share_.block(b)[c] = mass > 0.0 ? asked_.block(b)[c] / mass : 0.0;
            if (share_.block(b)[c] > 0.0) isAsked_[n] = 1;
        }
    });
}

/// Liquid that comes to a vertex with its momentum.
void Capture::deposit(std::size_t v, double mass, const Vec3& momentum, FabricState& state)
{
    const double before = fabric_.mass[v] + state.absorbed[v];
    state.absorbed[v] += mass;
    if (fabric_.pinned[v]) pinImpulse_[v] += momentum - mass * state.v[v];
    else state.v[v] = (before * state.v[v] + momentum) / (before + mass);
}

double Capture::absorb(const Around& around, FabricState& state)
{
    const SortedVertices& vertices = around.vertices();
    std::ranges::fill(got_, 0.0);
    parallelFor(vertices.order.occupied.size(), [&](std::size_t n) {
        const int block = vertices.order.occupied[n];
        forEachUnsaturated(vertices, block, [&](std::size_t v, const CellStencil& stencil) {
            Pack got{};
            stencil.forEach(vertices.grid.neighbours(block), [&](int b, int c, double weight) {
                const Pack& cell = around.cell(b, c);
                // Of what is asked of the cell it gives all, or as much as it has.
                if (cell[LiquidAround::kMass] > 0.0) got += wanted_[v] / around.massAt(v) * weight / std::max(1.0, share_.block(b)[c]) * cell;
            });
            got_[v] = got[LiquidAround::kMass];
            constexpr int kFirst = LiquidAround::kMomentum;
            deposit(v, got[LiquidAround::kMass], {got[kFirst], got[kFirst + 1], got[kFirst + 2]}, state);
        });
    });
    return parallelSum(got_.size(), [&](std::size_t v) { return got_[v]; });
}

/// Particles give what the cells around them gave.
void Capture::removeFromParticles(const Around& around, LiquidParticles& liquid)
{
    const BlockGrid& grid = around.grid();
    parallelFor(around.near().size(), [&](std::size_t n) {
        const LiquidAround::Part& part = around.near()[n];
        const std::array<int, 27>& blocks = around.blocksAround(part.block);
        if (std::ranges::none_of(blocks, [&](int b) { return isAsked_[b] != 0; })) return;
        const Vec3 corner = grid.lowerCorner(part.block);
        LiquidAround::forEachParticle(around.order(), part, [&](int p) {
            double share = 0.0;
            const CellStencil stencil(liquid.position(p), corner, grid.dx);
            stencil.forEach(blocks, [&](int b, int c, double weight) { share += weight * std::min(1.0, share_.block(b)[c]); });
            liquid.mass[p] *= std::max(0.0, 1.0 - share);
        });
    });
}

/// The vertex nearest to a place that has room, of those within a stencil of it; the number of vertices if there is none.
std::size_t Capture::nearestWithRoom(const Vec3& x, double dx, const std::array<int, 27>& blocks, const SortedVertices& vertices,
                                     const FabricState& state) const
{
    double nearest = 2.25 * dx * dx;  // 1.5 cells: a stencil
    std::size_t taker = fabric_.vertexCount();
    for (int b : blocks) {
        if (b == vertices.grid.count()) continue;
        for (int n = vertices.order.begin(b); n < vertices.order.end(b); ++n) {
            const std::size_t v = vertices.particles.id[n];
            const double distance = (vertices.particles.position(n) - x).squaredNorm();
            if (distance < nearest && roomOf(v, state) > 0.0) nearest = distance, taker = v;
        }
    }
    return taker;
}

/// Particles that are hardly there any more go to the nearest vertex with room; few ever are.
double Capture::absorbResiduals(const Around& around, LiquidParticles& liquid, FabricState& state)
{
    double sum = 0.0;
    for (const LiquidAround::Part& part : around.near())
        LiquidAround::forEachParticle(around.order(), part, [&](int s) {
            if (liquid.mass[s] >= leastMass_) return;
            if (liquid.mass[s] > 0.0) {
                const std::size_t taker =
                    nearestWithRoom(liquid.position(s), around.grid().dx, around.blocksAround(part.block), around.vertices(), state);
                if (taker == fabric_.vertexCount()) return;
                const double mass = liquid.mass[s];
                deposit(taker, mass, mass * liquid.velocity(around.order().source[s]), state);
                sum += mass;
                liquid.mass[s] = 0.0;
            }
            emptied_.push_back(s);
        });
    return sum;
}

Capture::Uptake Capture::capture(double dt, const LiquidAround::Found& around, LiquidParticles& liquid, FabricState& state)
{
    emptied_.clear();
    std::ranges::fill(pinImpulse_, Vec3::Zero());
    double mass = 0.0;
    if (findUnsaturatedVertices(around.vertices(), state)) {
        computeDemand(dt, around);
        findShares(around);
        mass = absorb(around, state);
        removeFromParticles(around, liquid);
        mass += absorbResiduals(around, liquid, state);
    }
    return {mass, pinImpulse_, emptied_};
}

void Capture::removeEmptyParticles(const Uptake& uptake, LiquidParticles& liquid)
{
    for (std::size_t n = uptake.emptied.size(); n-- > 0;) {
        if (uptake.emptied[n] != liquid.count - 1) liquid.copy(liquid.count - 1, uptake.emptied[n]);
        liquid.resize(liquid.count - 1);
    }
}

}  // namespace sim
