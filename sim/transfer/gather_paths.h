#pragma once

#include "sim/transfer/contraction.h"
#include "sim/transfer/gather.h"

// Where particles go in G2P: along what they gather, by the midpoint rule (liquid/README.md, Reflection), and by the displacements of the volume.

namespace sim {

struct GatherTile {
    alignas(64) double v[kAxes][kTileSize];
};

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

/// Up to 8 particles of one cell.
struct Batch {
    int first, count;
    int node;         ///< node of the tiles where their stencils begin
    bool atMidpoint;  ///< whether they move by the midpoint rule
};

/// x += the displacements on the faces, interpolated at x.
[[gnu::noinline]] inline void displace(const Context& ctx, int node, Pack (&x)[3])
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

/// Velocities along the paths of 8 particles by the midpoint rule, from the velocities that move them where they are, and their gradients.
template <int kFactors>
[[gnu::always_inline]] inline void goToMidpoint(const Context& ctx, const Coefficients<kFactors> (&c)[3], Pack (&path)[3])
{
    const double half = 0.5 * ctx.settings.dt / ctx.dx;
    Pack past[3];
    for (int a = 0; a < kAxes; ++a) past[a] = c[a][0][0][0] - ctx.frame[a];
    for (int a = 0; a < kAxes; ++a) path[a] = c[a][0][0][0] + half * (c[a][1][0][0] * past[0] + c[a][0][1][0] * past[1] + c[a][0][0][1] * past[2]);
}

/// The same where what moves them is not what they gather, or that has no gradient: out of line, for the others pay nothing.
[[gnu::noinline]] inline void gatherPaths(const Context& ctx, int node, const Pack (&x)[3], Pack (&path)[3])
{
    Operators<2> op[3];
    for (int a = 0; a < kAxes; ++a) {
        const Pack inCells = (x[a] - ctx.origin[a]) * (1.0 / ctx.dx);
        setOperators<2, false>(inCells - floorPack(inCells), op[a]);
    }
    Coefficients<2> c[3];
    unroll<3>([&](auto a) { contract<a, ModeSet<4>>(ctx.moving.v[a] + node, op, c[a]); });
    goToMidpoint(ctx, c, path);
}

/// Velocities along the paths of a batch that has gathered c.
template <class Set>
[[gnu::always_inline]] inline void findPaths(const Context& ctx, const Batch& batch, const Pack (&x)[3], const Coefficients<Set::kFactors> (&c)[3],
                                             Pack (&path)[3])
{
    if (!batch.atMidpoint) {
        for (int a = 0; a < kAxes; ++a) path[a] = meanVelocity<Set>(c[a]);
        return;
    }
    if constexpr (Set::kFactors == 2)  // with quadratic modes the gradient is not among them
        if (ctx.settings.reflected == nullptr && ctx.modes >= 4 && ctx.settings.keep == 1.0) return goToMidpoint(ctx, c, path);
    gatherPaths(ctx, batch.node, x, path);
}

}  // namespace sim
