#include "sim/transfer/scatter.h"

#include "sim/core/simd.h"
#include "sim/core/spline.h"
#include "sim/transfer/mode_set.h"
#include "sim/transfer/scatter_blocks.h"

namespace sim {

namespace {

/// Quadratic B-spline weights of four nodes in a row as polynomials of the offset r: (A r + B) r + C, without branches.
/// Type 0: r from the cell's middle, nodes at its first three positions. Types 1 and 2: r from the lower or upper face of the
/// cell, nodes at the first or last three of four positions.
struct SplineRow {
    Pack a, b, c;
    [[gnu::always_inline]] Pack operator()(double r) const { return (a * r + b) * r + c; }
};

/// The 16 nodes of a plane are lane x + 4 y: lanes of rows y = 0, 1 in one pack and of rows 2, 3 in the other. What depends on x
/// alone is the same in both.
struct PlaneTables {
    SplineRow x[3], y[3][2];
    Pack laneX, laneY[2];  ///< position of the node relative to the cell, for nodes at −1, 0, 1, 2

    PlaneTables()
    {
        constexpr double kA[3] = {0.5, -1.0, 0.5}, kB[3] = {-0.5, 0.0, 0.5}, kC[3] = {0.125, 0.75, 0.125};
        for (int type = 0; type < 3; ++type) {
            const int first = type == 2 ? 1 : 0;
            const auto set = [&](SplineRow& row, int lane, int node) {
                const int n = node - first;
                const bool inside = n >= 0 && n < 3;
                row.a[lane] = inside ? kA[n] : 0.0;
                row.b[lane] = inside ? kB[n] : 0.0;
                row.c[lane] = inside ? kC[n] : 0.0;
            };
            for (int lane = 0; lane < kLanes; ++lane) {
                set(x[type], lane, lane & 3);
                for (int half = 0; half < 2; ++half) set(y[type][half], lane, (lane >> 2) + 2 * half);
            }
        }
        for (int lane = 0; lane < kLanes; ++lane) {
            laneX[lane] = (lane & 3) - 1;
            for (int half = 0; half < 2; ++half) laneY[half][lane] = (lane >> 2) + 2 * half - 1;
        }
    }
};

/// What the planes need of 8 particles, computed once for all three face grids.
template <int kFactors>
struct Prepared {
    double x[kLanes], y[kLanes];              ///< position in the cell, in cells
    double middleX[kLanes], middleY[kLanes];  ///< offset from the cell's middle
    double faceX[kLanes], faceY[kLanes];      ///< offset from the nearer face
    double centerZ[3][kFactors][kLanes];      ///< mass × weight × z^d of the three cell middles around
    double faceZ[4][kFactors][kLanes];        ///< factors along z of the four faces around
    int typeX[kLanes], typeY[kLanes];         ///< spline type of faceX, faceY: 1 or 2
};

template <int kFactors>
[[gnu::always_inline]] inline void storePowers(double (*out)[kLanes], Pack weight, Pack z)
{
    unroll<kFactors>([&](auto d) {
        std::memcpy(out[d], &weight, sizeof weight);
        weight *= z;
    });
}

template <int kFactors>
inline void prepare(const Particles& particles, const Vec3& origin, double inverseDx, int first, int last, Prepared<kFactors>* out)
{
    const auto inCell = [&](int axis, int s) {
        const Pack p = (loadPack(particles.x[axis].data() + s) - origin[axis]) * inverseDx;
        return p - floorPack(p);
    };
    for (int s = first; s < last; s += kLanes, ++out) {
        const Pack x = inCell(0, s), y = inCell(1, s), z = inCell(2, s), mass = loadPack(particles.mass.data() + s);
        const PackMask upperX = x >= 0.5, upperY = y >= 0.5, upperZ = z >= 0.5;
        const Pack faceX = select(upperX, x - 1.0, x), faceY = select(upperY, y - 1.0, y);
        std::memcpy(out->x, &x, sizeof x);
        std::memcpy(out->y, &y, sizeof y);
        const Pack middleX = x - 0.5, middleY = y - 0.5;
        std::memcpy(out->middleX, &middleX, sizeof middleX);
        std::memcpy(out->middleY, &middleY, sizeof middleY);
        std::memcpy(out->faceX, &faceX, sizeof faceX);
        std::memcpy(out->faceY, &faceY, sizeof faceY);
        for (int l = 0; l < kLanes; ++l) {
            out->typeX[l] = upperX[l] ? 2 : 1;
            out->typeY[l] = upperY[l] ? 2 : 1;
        }
        const Pack zero = broadcast(0.0);
        const auto weights = [&](Pack r, Pack(&w)[3]) {
            splineWeights(r, w);
            for (Pack& share : w) share = mass * share;
        };
        Pack w[3];
        weights(z - 0.5, w);
        for (int n = 0; n < 3; ++n) storePowers<kFactors>(out->centerZ[n], w[n], (n - 0.5) - z);
        weights(select(upperZ, z - 1.0, z), w);
        for (int n = 0; n < 4; ++n) {
            const Pack lower = n < 3 ? w[n] : zero, upper = n > 0 ? w[n - 1] : zero;
            storePowers<kFactors>(out->faceZ[n], select(upperZ, upper, lower), (n - 1.0) - z);
        }
    }
}

/// Σ over the degrees in x of mode (·, b, c), by Horner.
template <class Set, int b, int c>
[[gnu::always_inline]] inline Pack polynomialX(const double* const* mode, int row, Pack x)
{
    constexpr int kCount = Set::countX(b, c);
    Pack v = broadcast(mode[Set::template kMode<kCount - 1, b, c>][row]);
    if constexpr (kCount >= 3) v = v * x + mode[Set::template kMode<1, b, c>][row];
    if constexpr (kCount >= 2) v = v * x + mode[Set::template kMode<0, b, c>][row];
    return v;
}

using Row = double __attribute__((vector_size(32)));

[[gnu::always_inline]] inline Row lowerRow(Pack v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }

/// Numbers at the nodes of a plane: rows y = 0, 1 in one pack; in another rows 2 and 3, or in half a pack row 2 where that is the last.
template <int kRows>
struct Plane {
    using Upper = std::conditional_t<kRows == 4, Pack, Row>;
    Pack lower = {};
    Upper upper = {};

    Plane() = default;
    [[gnu::always_inline]] Plane(Pack rows01, Pack rows23) : lower(rows01)
    {
        if constexpr (kRows == 4) upper = rows23;
        else upper = lowerRow(rows23);
    }

    [[gnu::always_inline]] Plane& operator+=(const Plane& other)
    {
        lower += other.lower;
        upper += other.upper;
        return *this;
    }
    [[gnu::always_inline]] friend Plane operator+(Plane a, const Plane& b) { return a += b; }
    [[gnu::always_inline]] friend Plane operator*(Plane a, const Plane& b)
    {
        a.lower *= b.lower;
        a.upper *= b.upper;
        return a;
    }
    [[gnu::always_inline]] friend Plane operator*(const Plane& a, double b) { return a * Plane(broadcast(b), broadcast(b)); }
};

template <int kRows>
[[gnu::always_inline]] inline void addRows(double* tile, const Plane<kRows>& plane)
{
    unroll<kRows>([&](auto row) {
        HalfPack part, sum;
        std::memcpy(&part,
                    (row < 2 ? reinterpret_cast<const char*>(&plane.lower) : reinterpret_cast<const char*>(&plane.upper)) + (row % 2) * sizeof part,
                    sizeof part);
        std::memcpy(&sum, tile + row * kTileStrideY, sizeof sum);
        sum += part;
        std::memcpy(tile + row * kTileStrideY, &sum, sizeof sum);
    });
}

constexpr int kPrefetchAhead = 48;  ///< particles; measured (transfer/README.md, Kernels)

/// Fetch the modes of a particle to come, where its row starts a new cache line or breaks a run of rows.
template <int kModes>
[[gnu::always_inline]] inline void prefetchModes(const double* const* mode, const int* source)
{
    const int row = source[kPrefetchAhead];
    if (row != source[kPrefetchAhead - 1] + 1 || (row & 7) == 0) unroll<kModes>([&](auto r) { __builtin_prefetch(mode[r] + row); });
}

/// The particles of a block, with the modes of one component.
template <int kFactors, int kModes>
struct BlockParticles {
    int first;
    const Prepared<kFactors>* prepared;
    const int* source;  ///< ParticleOrder::source
    const double* mode[kModes];
};

/// A column of 8 cells.
struct Column {
    const int* start;  ///< cellStart of its cells
    int low, high;     ///< the cells to visit
};

/// All particles of a column, onto the faces normal to kAxis: mass and momentum in the tile. A window of planes slides up the column: the sums of a
/// cell stay in registers, and a plane goes to the tile when no further cell reaches it.
template <int kAxis, class Set, int kModes>
[[gnu::noinline, gnu::flatten]] void scatterColumn(const PlaneTables& tables, const Column& column,
                                                   const BlockParticles<Set::kFactors, kModes>& particles, double* mass, double* momentum)
{
    const auto [start, low, high] = column;
    const auto* const prepared = particles.prepared;
    const int *const source = particles.source, blockFirst = particles.first;
    const double* const* mode = particles.mode;
    constexpr int kPlanes = kAxis == 2 ? 4 : 3, kRows = kAxis == 1 ? 4 : 3;
    Plane<kRows> m[kPlanes], p[kPlanes];
    for (int k = low; k <= high; ++k) {
        for (int s = start[k]; s < start[k + 1]; ++s) {
            const auto& q = prepared[(s - blockFirst) / kLanes];
            const int l = (s - blockFirst) % kLanes, row = source[s];
            prefetchModes<kModes>(mode, source + s);
            const Pack x = tables.laneX - (kAxis == 0 ? q.x[l] : q.middleX[l]);
            const Pack wx = kAxis == 0 ? tables.x[q.typeX[l]](q.faceX[l]) : tables.x[0](q.middleX[l]);
            const double offsetY = kAxis == 1 ? q.y[l] : q.middleY[l], ry = kAxis == 1 ? q.faceY[l] : q.middleY[l];
            const SplineRow(&splineY)[2] = kAxis == 1 ? tables.y[q.typeY[l]] : tables.y[0];
            const Plane<kRows> y(tables.laneY[0] - offsetY, tables.laneY[1] - offsetY), w(wx * splineY[0](ry), wx * splineY[1](ry));
            const auto weightZ = [&](auto n, auto d) { return kAxis == 2 ? q.faceZ[n][d][l] : q.centerZ[n % 3][d][l]; };
            unroll<kPlanes>([&](auto n) { m[n] += w * weightZ(n, std::integral_constant<int, 0>{}); });
            unroll<Set::kFactors>([&](auto c) {
                constexpr int kCountY = Set::countY(c);
                const Pack top = polynomialX<Set, kCountY - 1, c>(mode, row, x);
                Plane<kRows> poly(top, top);
                unroll<kCountY - 1>([&](auto b) {
                    const Pack next = polynomialX<Set, kCountY - 2 - b, c>(mode, row, x);
                    poly = poly * y + Plane<kRows>(next, next);
                });
                const Plane<kRows> value = poly * w;
                unroll<kPlanes>([&](auto n) { p[n] += value * weightZ(n, c); });
            });
        }
        addRows(mass + k * kTileStrideZ, m[0]);
        addRows(momentum + k * kTileStrideZ, p[0]);
        unroll<kPlanes - 1>([&](auto n) {
            m[n] = m[n + 1];
            p[n] = p[n + 1];
        });
        m[kPlanes - 1] = p[kPlanes - 1] = {};
    }
    const int above = high + 1;
    unroll<kPlanes - 1>([&](auto n) {
        addRows(mass + (above + n) * kTileStrideZ, m[n]);
        addRows(momentum + (above + n) * kTileStrideZ, p[n]);
    });
}

template <int kAxis, class Set, int kModes>
inline void scatterAxis(const PlaneTables& tables, const SortedParticles& sorted, int block, const OccupiedBox& box,
                        const Prepared<Set::kFactors>* prepared, ScatterTile& tile)
{
    const ParticleOrder& order = sorted.order;
    BlockParticles<Set::kFactors, kModes> particles{order.begin(block), prepared, order.source.data(), {}};
    for (int r = 0; r < kModes; ++r) particles.mode[r] = sorted.particles.mode(kAxis, r);
    for (int i = box.low[0]; i <= box.high[0]; ++i)
        for (int j = box.low[1]; j <= box.high[1]; ++j) {
            const int* start = order.cells(block) + cellRank(i, j, 0);
            if (start[0] == start[kBlockEdge]) continue;
            const int corner = tileIndex(i - 1, j - 1, -1);
            scatterColumn<kAxis, Set, kModes>(tables, {start, box.low[2], box.high[2]}, particles, tile.v[FaceFields::kMass + kAxis] + corner,
                                              tile.v[FaceFields::kMomentum + kAxis] + corner);
        }
}

}  // namespace

void particlesToFaces(const SortedParticles& sorted, ScatterScratch& scratch, FaceFields& faces)
{
    const Particles& particles = sorted.particles;
    const ParticleOrder& order = sorted.order;
    const BlockGrid& grid = sorted.grid;
    withModeSet(particles.modeCount, [&]<int kModes>(ModeSet<kModes>) {
        using Set = ModeSet<kModes>;
        using Batch = Prepared<Set::kFactors>;
        const PlaneTables tables;
        const std::size_t batches = order.maxParticlesPerBlock / kLanes + 1;
        scratch.perWorker.resize(workerCount());
        for (auto& s : scratch.perWorker) s.resize(batches * sizeof(Batch) / sizeof(double));

        scatterBlocks(order, grid, faces, [&](int block, const OccupiedBox& box, int worker, ScatterTile& tile) {
            auto* prepared = reinterpret_cast<Batch*>(scratch.perWorker[worker].data());
            prepare(particles, grid.origin, 1.0 / grid.dx, order.begin(block), order.end(block), prepared);
            scatterAxis<0, Set, kModes>(tables, sorted, block, box, prepared, tile);
            scatterAxis<1, Set, kModes>(tables, sorted, block, box, prepared, tile);
            scatterAxis<2, Set, kModes>(tables, sorted, block, box, prepared, tile);
        });
    });
}

}  // namespace sim
