#include "sim/transfer/gather.h"

#include "sim/core/parallel.h"
#include "sim/transfer/contraction.h"
#include "sim/transfer/mode_window.h"
#include "sim/transfer/reference.h"

namespace sim {

namespace {

struct GatherTile {
    alignas(64) double v[kAxes][kTileSize];
};

void loadTile(const BlockArray<double, 3>& velocity, const BlockGrid& grid, int block, const OccupiedBox& box, GatherTile& tile)
{
    forEachTileRow(grid, block, box, [&](int piece, int cell, int node, auto length) {
        for (int a = 0; a < kAxes; ++a) {
            const double* from = velocity.block(piece, a) + cell;
            double* to = tile.v[a] + node;
            for (int n = 0; n < length; ++n) to[n] = from[n];
        }
    });
}

/// Everything the packs of one block share.
struct Context {
    const GatherSettings& settings;
    Particles& particles;
    GatherScratch& scratch;
    Vec3 origin;
    double dx;
    const GatherTile& tile;              ///< tile of the velocities whose modes are gathered
    const GatherTile& moving;            ///< tile of the velocities that the particles move with
    const GatherTile* flipTile;          ///< tile of the old velocities, or null
    const GatherTile* displacementTile;  ///< tile of the displacements, or null
    int modes;                           ///< N_r
    Vec3 frame;                          ///< velocity of the frame in which particles move by the midpoint rule [cm/s]
};

struct LaneSums {
    Pack momentum[3] = {broadcast(0.0), broadcast(0.0), broadcast(0.0)};
    Pack kinetic = broadcast(0.0), modal = broadcast(0.0), strain = broadcast(0.0), maxSpeedSquared = broadcast(0.0), maxPathSquared = broadcast(0.0);
};

/// Up to 8 particles of one cell.
struct Batch {
    int first, count;
    int node;         ///< node of the tiles where their stencils begin
    bool atMidpoint;  ///< whether they move by the midpoint rule
};

/// Gather one component of a batch: monomials, in c and in the particles' rows.
template <int kAxis, class Set, int kModes, bool kFold, class Rows>
[[gnu::always_inline]] inline void gatherAxis(const Context& ctx, const Batch& batch, const Operators<Set::kFactors>* op, Rows& rows,
                                              Coefficients<Set::kFactors>& c)
{
    const int s = batch.first, n = batch.count, node = batch.node;
    contract<kAxis, Set>(ctx.tile.v[kAxis] + node, op, c);
    if (ctx.modes < kModes) truncate<kModes, Set::kFactors>(ctx.modes, c);
    if constexpr (kModes == 1) {
        if (ctx.flipTile != nullptr) {
            Coefficients<1> old;
            contract<kAxis, Set>(ctx.flipTile->v[kAxis] + node, op, old);
            const Pack flip = loadPack(ctx.scratch.oldVelocity[kAxis].data() + s) + (c[0][0][0] - old[0][0][0]);
            storeFirst(rows.at(kAxis, 0, s), ctx.settings.flipRatio * flip + (1.0 - ctx.settings.flipRatio) * c[0][0][0], n);
            return;
        }
    }
    if constexpr (Set::kFactors > 2 && !kFold) {
        Pack skew[3];
        unroll<3>([&](auto a) {
            const Pack r = a == kAxis ? op[a].faceOffset : op[a].centerOffset;
            skew[a] = r * (1.0 - 4.0 * r * r);
        });
        convert<Set>(-1.0, skew, c);
    }
    if (ctx.settings.keep != 1.0) {
        const Pack mean = meanVelocity<Set>(c);
        forEachMode<kModes>([&](auto, auto a, auto b, auto d) { c[a][b][d] *= ctx.settings.keep; });
        c[0][0][0] += (1.0 - ctx.settings.keep) * mean;
    }
    forEachMode<kModes>([&](auto r, auto a, auto b, auto d) { storeFirst(rows.at(kAxis, r, s), c[a][b][d], n); });
}

/// Orthogonal offset of a new position xi (in cells, any cell) from its middle node: face-like along its own axis.
template <int kAxis>
[[gnu::always_inline]] inline Pack newOffset(int a, Pack xi)
{
    const Pack in = xi - floorPack(xi);
    return a == kAxis ? select(in >= 0.5, in - 1.0, in) : in - 0.5;
}

/// x += the displacements on the faces, interpolated at x.
[[gnu::noinline]] void displace(const Context& ctx, int node, Pack (&x)[3])
{
    Operators<1> op[3];
    for (int a = 0; a < kAxes; ++a) {
        const Pack inCells = (x[a] - ctx.origin[a]) * (1.0 / ctx.dx);
        setOperators<1, false>(inCells - floorPack(inCells), op[a]);
    }
    unroll<3>([&](auto a) {
        Coefficients<1> c;
        contract<a, ModeSet<1>>(ctx.displacementTile->v[a] + node, op, c);
        x[a] += c[0][0][0];
    });
}

/// Velocities along the paths of 8 particles at x by the midpoint rule: out of line, for the others pay nothing.
[[gnu::noinline]] void findPaths(const Context& ctx, int node, const Pack (&x)[3], Pack (&path)[3])
{
    Operators<2> op[3];
    for (int a = 0; a < kAxes; ++a) {
        const Pack inCells = (x[a] - ctx.origin[a]) * (1.0 / ctx.dx);
        setOperators<2, false>(inCells - floorPack(inCells), op[a]);
    }
    Coefficients<2> c[3];
    unroll<3>([&](auto a) { contract<a, ModeSet<4>>(ctx.moving.v[a] + node, op, c[a]); });
    const double half = 0.5 * ctx.settings.dt / ctx.dx;
    Pack past[3];
    for (int a = 0; a < kAxes; ++a) past[a] = c[a][0][0][0] - ctx.frame[a];
    for (int a = 0; a < kAxes; ++a) path[a] = c[a][0][0][0] + half * (c[a][1][0][0] * past[0] + c[a][0][1][0] * past[1] + c[a][0][0][1] * past[2]);
}

[[gnu::always_inline]] inline Pack squaredNorm(const Pack (&v)[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

constexpr int kMostDirect = 8;  ///< modes; more leave through a window
constexpr int kRowsAhead = 64;  ///< particles; rows are overwritten, so fetch them for writing (transfer/README.md, Kernels)

template <class Set, int kModes, bool kFold, class Rows>
[[gnu::flatten, gnu::noinline]] void gatherPack(const Context& ctx, const Batch& batch, Rows& rows, LaneSums& sums)
{
    const int s = batch.first, n = batch.count, node = batch.node;
    Particles& particles = ctx.particles;
    if constexpr (std::is_same_v<Rows, DirectModes>)
        for (int a = 0; a < kAxes; ++a)
            for (int r = 0; r < kModes; ++r) __builtin_prefetch(rows.at(a, r, s + kRowsAhead), 1);

    Operators<Set::kFactors> op[3];
    Pack x[3];
    for (int a = 0; a < kAxes; ++a) {
        x[a] = loadPack(particles.x[a].data() + s);
        const Pack inCells = (x[a] - ctx.origin[a]) * (1.0 / ctx.dx);
        setOperators<Set::kFactors, kFold>(inCells - floorPack(inCells), op[a]);
    }
    Coefficients<Set::kFactors> c[3];
    gatherAxis<0, Set, kModes, kFold>(ctx, batch, op, rows, c[0]);
    gatherAxis<1, Set, kModes, kFold>(ctx, batch, op, rows, c[1]);
    gatherAxis<2, Set, kModes, kFold>(ctx, batch, op, rows, c[2]);

    const PackMask lanes = firstLanes(n);
    const Pack zero = broadcast(0.0), mass = select(lanes, loadPack(particles.mass.data() + s), zero);
    Pack path[3];
    if (batch.atMidpoint) findPaths(ctx, node, x, path);
    else
        for (int a = 0; a < kAxes; ++a) path[a] = meanVelocity<Set>(c[a]);
    if (ctx.settings.atMidpoint != nullptr) sums.maxPathSquared = maxPack(sums.maxPathSquared, select(lanes, squaredNorm(path), zero));
    if (ctx.displacementTile != nullptr) displace(ctx, node, x);
    Pack speedSquared = zero, xi[3];
    for (int a = 0; a < kAxes; ++a) {
        x[a] += ctx.settings.dt * path[a];
        if (ctx.settings.displacement != nullptr) x[a] += loadPack(ctx.settings.displacement[a].data() + s);
        storeFirst(particles.x[a].data() + s, x[a], n);
        xi[a] = (x[a] - ctx.origin[a]) * (1.0 / ctx.dx);
        const Pack carried = ctx.flipTile != nullptr ? loadPack(rows.at(a, 0, s)) : meanVelocity<Set>(c[a]);
        speedSquared += carried * carried;
        sums.momentum[a] += select(lanes, mass * carried, zero);
    }
    speedSquared = select(lanes, speedSquared, zero);
    sums.kinetic += mass * speedSquared;
    // The comparison is false for a NaN, which must not be lost.
    sums.maxSpeedSquared = select(speedSquared < sums.maxSpeedSquared, sums.maxSpeedSquared, speedSquared);
    if constexpr (kModes > 1) {
        Pack modal = zero;
        unroll<3>([&](auto axis) {
            Pack r[3];
            if constexpr (Set::kFactors > 2) {
                Pack skew[3];
                unroll<3>([&](auto a) {
                    r[a] = newOffset<axis>(a, xi[a]);
                    skew[a] = r[a] * (1.0 - 4.0 * r[a] * r[a]);
                });
                convert<Set>(1.0, skew, c[axis]);
            }
            modal += modalSquare<Set>(r, c[axis]);
        });
        sums.modal += mass * select(lanes, modal, zero);
        sums.strain += mass * select(lanes, strainSquare<Set>(c), zero);
    }
}

/// a unless b is larger: a NaN in a is not lost.
double larger(double a, double b) { return a < b ? b : a; }

template <class Set, int kModes, bool kFold>
GatherSums gatherBlock(const ParticleOrder& order, int block, const OccupiedBox& box, const Context& ctx)
{
    LaneSums lanes;
    GatherSums sums;
    std::conditional_t<(kModes > kMostDirect), ModeWindow<kModes>, DirectModes> rows(ctx.particles, order.begin(block));
    for (int i = box.low[0]; i <= box.high[0]; ++i)
        for (int j = box.low[1]; j <= box.high[1]; ++j)
            for (int k = box.low[2]; k <= box.high[2]; ++k) {
                const int* start = order.cells(block) + cellRank(i, j, k);
                if (start[0] == start[1]) continue;
                const int node = tileIndex(i - 1, j - 1, k - 1), cell = cellInBlock(i, j, k);
                const bool atMidpoint = ctx.settings.atMidpoint != nullptr && ctx.settings.atMidpoint->test(block, cell);
                if constexpr (kModes > kModesAtSurface)
                    if (ctx.settings.manyModes != nullptr && !ctx.settings.manyModes->test(block, cell)) {
                        for (int s = start[0]; s < start[1]; s += kLanes) {
                            const int n = std::min(kLanes, start[1] - s);
                            rows.advanceTo(s);
                            gatherPack<ModeSet<kModesAtSurface>, kModesAtSurface, false>(ctx, {s, n, node, atMidpoint}, rows, lanes);
                            for (int a = 0; a < kAxes; ++a)
                                for (int r = kModesAtSurface; r < kModes; ++r) storeFirst(rows.at(a, r, s), broadcast(0.0), n);
                        }
                        continue;
                    }
                for (int s = start[0]; s < start[1]; s += kLanes) {
                    rows.advanceTo(s);
                    gatherPack<Set, kModes, kFold>(ctx, {s, std::min(kLanes, start[1] - s), node, atMidpoint}, rows, lanes);
                }
            }
    rows.finish(order.end(block));
    for (int a = 0; a < kAxes; ++a) sums.momentum[a] += sumLanes(lanes.momentum[a]);
    sums.kinetic += 0.5 * sumLanes(lanes.kinetic);
    sums.modal += 0.5 * sumLanes(lanes.modal);
    sums.strain += 0.5 * sumLanes(lanes.strain);
    for (int l = 0; l < kLanes; ++l) {
        sums.maxSpeedSquared = larger(lanes.maxSpeedSquared[l], sums.maxSpeedSquared);
        sums.maxPathSquared = larger(lanes.maxPathSquared[l], sums.maxPathSquared);
    }
    return sums;
}

/// FLIP adds to the old velocity, which G2P overwrites in another particle's row: bring it into the sorted order first.
void sortOldVelocities(const Particles& particles, const ParticleOrder& order, GatherScratch& scratch)
{
    for (auto& v : scratch.oldVelocity) v.resize(particles.mass.size());
    parallelFor(particles.count, 4096, [&](std::size_t s) {
        for (int a = 0; a < kAxes; ++a) scratch.oldVelocity[a][s] = particles.mode(a, 0)[order.source[s]];
    });
}

}  // namespace

GatherSums facesToParticles(const FaceFields& faces, const ParticleOrder& order, const BlockGrid& grid, const GatherSettings& settings,
                            GatherScratch& scratch, Particles& particles)
{
    if (settings.flipVelocity != nullptr) sortOldVelocities(particles, order, scratch);
    scratch.perBlock.resize(order.occupied.size());
    withModeSet(particles.modeCount, [&]<int kModes>(ModeSet<kModes>) {
        parallelFor(order.occupied.size(), [&](std::size_t n) {
            const int block = order.occupied[n];
            const OccupiedBox box(order.cells(block));
            GatherTile tile, moving, flipTile, displacementTile;
            loadTile(settings.reflected ? *settings.reflected : faces.velocity, grid, block, box, tile);
            if (settings.reflected != nullptr) loadTile(faces.velocity, grid, block, box, moving);
            if (settings.flipVelocity != nullptr) loadTile(*settings.flipVelocity, grid, block, box, flipTile);
            if (settings.faceDisplacement != nullptr) loadTile(*settings.faceDisplacement, grid, block, box, displacementTile);
            const Context ctx{settings,
                              particles,
                              scratch,
                              grid.origin,
                              grid.dx,
                              tile,
                              settings.reflected ? moving : tile,
                              settings.flipVelocity ? &flipTile : nullptr,
                              settings.faceDisplacement ? &displacementTile : nullptr,
                              settings.modes,
                              settings.frames ? settings.frames[block] : Vec3(Vec3::Zero())};
            if (kModes == 27 && settings.modes == 27)
                scratch.perBlock[n] = gatherBlock<ModeSet<kModes>, kModes, kModes == 27>(order, block, box, ctx);
            else scratch.perBlock[n] = gatherBlock<ModeSet<kModes>, kModes, false>(order, block, box, ctx);
        });
    });
    GatherSums total;
    for (const GatherSums& s : scratch.perBlock) {
        total.momentum += s.momentum;
        total.kinetic += s.kinetic;
        total.modal += s.modal;
        total.strain += s.strain;
        total.maxSpeedSquared = larger(s.maxSpeedSquared, total.maxSpeedSquared);
        total.maxPathSquared = larger(s.maxPathSquared, total.maxPathSquared);
    }
    return total;
}

}  // namespace sim
