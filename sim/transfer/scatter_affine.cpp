#include "sim/transfer/scatter_affine.h"

#include "sim/core/simd.h"
#include "sim/transfer/mode_set.h"
#include "sim/transfer/reference.h"
#include "sim/transfer/scatter_blocks.h"

#include <Eigen/LU>

namespace sim {

namespace {

constexpr double kSmallestVolumeRatio = 0.1;  ///< det(I + dt C) below which the map is not to be trusted (transfer/README.md, Maps)
constexpr int kPacks = 4;  ///< packs for the 27 nodes of a stencil, node (i, j, k) at i + 3 j + 9 k; lanes left over have no weight

/// The nodes of one particle's stencil, as lanes.
struct StencilPacks {
    explicit StencilPacks(const Basis& basis)
    {
        double at[kAxes][kPacks * kLanes] = {}, w[kPacks * kLanes] = {};
        int n = 0;
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i, ++n) {
                    at[0][n] = basis[0].z[i];
                    at[1][n] = basis[1].z[j];
                    at[2][n] = basis[2].z[k];
                    w[n] = basis[0].weight[i] * basis[1].weight[j] * basis[2].weight[k];
                }
        for (int pack = 0; pack < kPacks; ++pack) {
            for (int a = 0; a < kAxes; ++a) z[a][pack] = loadPack(at[a] + pack * kLanes);
            weight[pack] = loadPack(w + pack * kLanes);
        }
    }
    Pack z[kAxes][kPacks];  ///< node − particle, in cells
    Pack weight[kPacks];
};

/// The polynomial of a mode set at 8 places, by Horner.
template <class Set>
Pack evaluatePolynomial(const Modes& c, Pack x, Pack y, Pack z)
{
    Pack value = broadcast(0.0);
    unroll<Set::kFactors>([&](auto fromTopZ) {
        constexpr int kZ = Set::kFactors - 1 - fromTopZ, kCountY = Set::countY(kZ);
        Pack plane = broadcast(0.0);
        unroll<kCountY>([&](auto fromTopY) {
            constexpr int kY = kCountY - 1 - fromTopY, kCountX = Set::countX(kY, kZ);
            Pack row = broadcast(0.0);
            unroll<kCountX>([&](auto fromTopX) { row = row * x + c[Set::template kMode<kCountX - 1 - fromTopX, kY, kZ>]; });
            plane = plane * y + row;
        });
        value = value * z + plane;
    });
    return value;
}

/// All modes of one particle.
struct ParticleModes {
    ParticleModes(const Particles& particles, int row)
    {
        for (int a = 0; a < kAxes; ++a)
            for (int r = 0; r < particles.modeCount; ++r) c[a][r] = particles.mode(a, r)[row];
    }
    /// Rows are the gradients of the components, in velocity per cell.
    Mat3 gradient() const
    {
        Mat3 g;
        for (int a = 0; a < kAxes; ++a) g.row(a) << c[a][1], c[a][2], c[a][3];
        return g;
    }
    Vec3 mean() const { return {meanOf(c[0]), meanOf(c[1]), meanOf(c[2])}; }
    std::array<Modes, kAxes> c{};
};

/// Where the material point at z now was when the modes were gathered, both relative to the particle.
Mat3 inverseMotion(const Mat3& gradient, double dtPerCell)
{
    const Mat3 motion = Mat3::Identity() + dtPerCell * gradient;
    if (!(motion.determinant() >= kSmallestVolumeRatio)) return Mat3::Identity();
    return motion.inverse();
}

/// Give the values of one component the weighted mean and gradient that they had when they were gathered, at position
/// `before`.
template <class Set>
void restoreMeanAndGradient(const BlockGrid& grid, int axis, const Vec3& before, const Modes& modes, const StencilPacks& nodes, Pack (&u)[kPacks])
{
    // Without squares the orthogonal coefficients are the monomial ones.
    const Modes gathered = Set::kDegree < 2 ? modes : toOrthogonal(Stencil(grid, axis, before).basis, modes);
    Pack sum = broadcast(0.0), moment[kAxes] = {sum, sum, sum};
    for (int n = 0; n < kPacks; ++n) {
        const Pack share = nodes.weight[n] * u[n];
        sum += share;
        for (int a = 0; a < kAxes; ++a) moment[a] += share * nodes.z[a][n];
    }
    const double mean = gathered[0] - sumLanes(sum);
    double slope[kAxes];
    for (int a = 0; a < kAxes; ++a) slope[a] = gathered[1 + a] - 4.0 * sumLanes(moment[a]);
    for (int n = 0; n < kPacks; ++n) u[n] += mean + slope[0] * nodes.z[0][n] + slope[1] * nodes.z[1][n] + slope[2] * nodes.z[2][n];
}

/// Add mass × weight and mass × weight × u to the 27 nodes of a tile that begin at `corner`.
void addToTile(double particleMass, const StencilPacks& nodes, const Pack (&u)[kPacks], double* mass, double* momentum, int corner)
{
    double m[kPacks * kLanes], p[kPacks * kLanes];
    for (int n = 0; n < kPacks; ++n) {
        const Pack share = particleMass * nodes.weight[n], carried = share * u[n];
        std::memcpy(m + n * kLanes, &share, sizeof share);
        std::memcpy(p + n * kLanes, &carried, sizeof carried);
    }
    for (int k = 0, n = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i, ++n) {
                const int node = corner + i + j * kTileStrideY + k * kTileStrideZ;
                mass[node] += m[n];
                momentum[node] += p[n];
            }
}

template <class Set>
void scatterParticle(const SortedParticles& sorted, int s, int block, XiMap map, double dt, ScatterTile& tile)
{
    const BlockGrid& grid = sorted.grid;
    const ParticleModes modes(sorted.particles, sorted.order.source[s]);
    const Vec3 x = sorted.particles.position(s);
    const Mat3 toOld = inverseMotion(modes.gradient(), dt / grid.dx);
    for (int axis = 0; axis < kAxes; ++axis) {
        const Stencil stencil(grid, axis, x);
        const StencilPacks nodes(stencil.basis);
        Pack u[kPacks];
        for (int n = 0; n < kPacks; ++n) {
            Pack z[kAxes];
            for (int a = 0; a < kAxes; ++a) z[a] = toOld(a, 0) * nodes.z[0][n] + toOld(a, 1) * nodes.z[1][n] + toOld(a, 2) * nodes.z[2][n];
            u[n] = evaluatePolynomial<Set>(modes.c[axis], z[0], z[1], z[2]);
        }
        if (map == XiMap::AffineConservative) restoreMeanAndGradient<Set>(grid, axis, x - dt * modes.mean(), modes.c[axis], nodes, u);
        const Vec3i first = stencil.first - kBlockEdge * grid.coords(block);
        addToTile(sorted.particles.mass[s], nodes, u, tile.v[FaceFields::kMass + axis], tile.v[FaceFields::kMomentum + axis],
                  tileIndex(first.x(), first.y(), first.z()));
    }
}

}  // namespace

bool differsFromTranslation(XiMap map, int modes) { return (map == XiMap::Affine && modes >= 4) || (map == XiMap::AffineConservative && modes > 4); }

void particlesToFacesAffine(const SortedParticles& sorted, XiMap map, double dt, FaceFields& faces)
{
    const ParticleOrder& order = sorted.order;
    withModeSet(sorted.particles.modeCount, [&]<int kModes>(ModeSet<kModes>) {
        scatterBlocks(order, sorted.grid, faces, [&](int block, const OccupiedBox&, int, ScatterTile& tile) {
            for (int s = order.begin(block); s < order.end(block); ++s) scatterParticle<ModeSet<kModes>>(sorted, s, block, map, dt, tile);
        });
    });
}

}  // namespace sim
