#include "sim/fabric/grid/block_points.h"

#include "sim/transfer/contraction.h"

// Gathering works on 8 points of a cell at once. Scattering takes them one by one, with the nodes of one plane as lanes
// and all planes of a cell in registers, so that points of one cell do not wait for each other's sums.

#include <cmath>

namespace sim {

namespace {

/// store(s, n, coefficients of each axis) for packs of n ≤ kLanes points from s on.
template <class Set, class Store>
[[gnu::always_inline]] inline void gather(const FaceTile& tile, const BlockPoints& points, std::size_t n, Store&& store)
{
    for (int c = points.blockBegin[n]; c < points.blockBegin[n + 1]; ++c) {
        const int corner = points.cells[c].corner, end = points.cells[c + 1].begin;
        for (int s = points.cells[c].begin; s < end; s += kLanes) {
            Operators<Set::kFactors> op[kAxes];
            unroll<kAxes>([&](auto a) { setOperators<Set::kFactors, false>(loadPack(points.inCell[a].data() + s), op[a]); });
            unroll<kAxes>([&](auto a) {
                Coefficients<Set::kFactors> found;
                contract<a, Set>(tile.v[a] + corner, op, found);
                store(a, s, std::min(kLanes, end - s), found);
            });
        }
    }
}

/// Quadratic B-spline weights of the nodes of a 4x4 plane, lane x + 4 y: rows y = 0, 1 in one pack and 2, 3 in another.
/// Polynomials (A r + B) r + C of the offset r. Kind 0: nodes at the middles of cells, the first three of four; 1 and
/// 2: at their sides, the first or the last three.
struct PlaneTables {
    struct Row {
        Pack a, b, c;
        [[gnu::always_inline]] Pack operator()(double r) const { return (a * r + b) * r + c; }
    };
    Row x[3], y[3][2];
    Pack nodeX[2], nodeY[2][2];  ///< positions of the nodes relative to the cell, for middles and for sides [cells]

    PlaneTables()
    {
        for (int lane = 0; lane < kLanes; ++lane)
            for (int kind = 0; kind < 3; ++kind) {
                const int shift = kind == 2 ? 1 : 0, isSide = kind > 0;
                setLane(x[kind], lane, (lane & 3) - shift);
                nodeX[isSide][lane] = (lane & 3) - (isSide ? 1.0 : 0.5);
                for (int half = 0; half < 2; ++half) {
                    setLane(y[kind][half], lane, (lane >> 2) + 2 * half - shift);
                    nodeY[isSide][half][lane] = (lane >> 2) + 2 * half - (isSide ? 1.0 : 0.5);
                }
            }
    }
    static void setLane(Row& row, int lane, int node)
    {
        constexpr double kA[3] = {0.5, -1.0, 0.5}, kB[3] = {-0.5, 0.0, 0.5}, kC[3] = {0.125, 0.75, 0.125};
        const bool isInside = node >= 0 && node < 3;
        row.a[lane] = isInside ? kA[node] : 0.0;
        row.b[lane] = isInside ? kB[node] : 0.0;
        row.c[lane] = isInside ? kC[node] : 0.0;
    }
};

/// w (node − point)^d of up to 8 points for the nodes along z.
template <int kTerms>
struct AlongZ {
    Pack of[2][4][kTerms];  ///< terms for each node, of the three along middles or the four along sides

    [[gnu::always_inline]] explicit AlongZ(Pack z)
    {
        Operators<1> op;
        setOperators<1, false>(z, op);
        const auto set = [&](Pack(&to)[kTerms], Pack weight, Pack distance) {
            to[0] = weight;
            for (int d = 1; d < kTerms; ++d) to[d] = to[d - 1] * distance;
        };
        for (int n = 0; n < 3; ++n) set(of[0][n], op.center[n][0], (n - 0.5) - z);
        for (int n = 0; n < 4; ++n) set(of[1][n], op.face[n][0], (n - 1.0) - z);
    }
};

[[gnu::always_inline]] inline void addPlane(const Pack (&plane)[2], int rows, double* tile)
{
    for (int row = 0; row < rows; ++row) {
        HalfPack part, sum;
        std::memcpy(&part, reinterpret_cast<const char*>(&plane[row / 2]) + (row % 2) * sizeof part, sizeof part);
        std::memcpy(&sum, tile + row * kTileStrideY, sizeof sum);
        sum += part;
        std::memcpy(tile + row * kTileStrideY, &sum, sizeof sum);
    }
}

/// Adds w Σ_d c_d (node − point)_z^d to the faces normal to kAxis, where form(kAxis, s)(x, y, c) sets the c_d of
/// point s at nodes that are at (x, y) from it.
template <int kAxis, int kTerms, class Form>
[[gnu::noinline, gnu::flatten]] void scatterAxis(const PlaneTables& tables, const BlockPoints& points, std::size_t n, const Form& form, double* tile)
{
    constexpr int kPlanes = kAxis == 2 ? 4 : 3, kRows = kAxis == 1 ? 4 : 3;
    const auto kindAndOffset = [](bool isSide, double at, int& kind) {
        kind = !isSide ? 0 : at >= 0.5 ? 2 : 1;
        return at - (!isSide ? 0.5 : at >= 0.5 ? 1.0 : 0.0);
    };
    for (int c = points.blockBegin[n]; c < points.blockBegin[n + 1]; ++c) {
        const int begin = points.cells[c].begin, end = points.cells[c + 1].begin;
        Pack sum[kPlanes][2] = {};
        for (int first = begin; first < end; first += kLanes) {
            const AlongZ<kTerms> z(loadPack(points.inCell[2].data() + first));
            for (int s = first; s < std::min(end, first + kLanes); ++s) {
                const double atX = points.inCell[0][s], atY = points.inCell[1][s];
                int kindX, kindY;
                const double rx = kindAndOffset(kAxis == 0, atX, kindX), ry = kindAndOffset(kAxis == 1, atY, kindY);
                const Pack wx = tables.x[kindX](rx), x = tables.nodeX[kAxis == 0] - atX;
                const auto termsAt = form(kAxis, s);
                unroll<2>([&](auto half) {
                    const Pack weight = wx * tables.y[kindY][half](ry);
                    Pack terms[kTerms];
                    const Pack y = tables.nodeY[kAxis == 1][half] - atY;
                    termsAt(x, y, terms);
                    unroll<kTerms>([&](auto d) {
                        const Pack value = weight * terms[d];
                        unroll<kPlanes>([&](auto k) { sum[k][half] += z.of[kAxis == 2][k][d][s - first] * value; });
                    });
                });
            }
        }
        unroll<kPlanes>([&](auto k) { addPlane(sum[k], kRows, tile + points.cells[c].corner + k * kTileStrideZ); });
    }
}

/// scatterAxis for each axis.
template <int kTerms, class Form>
void scatter(const BlockPoints& points, std::size_t n, const Form& form, FaceTile& tile)
{
    const PlaneTables tables;
    scatterAxis<0, kTerms>(tables, points, n, form, tile.v[0]);
    scatterAxis<1, kTerms>(tables, points, n, form, tile.v[1]);
    scatterAxis<2, kTerms>(tables, points, n, form, tile.v[2]);
}

/// What points give, as polynomials of the place of the node: numbers of their own, …
struct ValueTerms {
    const PointArray<3>& f;
    [[gnu::always_inline]] auto operator()(int a, int s) const
    {
        return [value = f.of[a][s]](Pack, Pack, Pack* c) { c[0] = broadcast(value); };
    }
};

/// Values of each point that are linear around it: numbers f_k times its directions d_k.
template <int kDirections>
struct AlongTerms {
    const PointArray<3 * kDirections>&d, &f;
    [[gnu::always_inline]] auto operator()(int a, int s) const
    {
        std::array<double, kAxes> slope{};
        unroll<kDirections>([&](auto k) {
            const double four = 4.0 * f.of[3 * k + a][s];
            unroll<kAxes>([&](auto b) { slope[b] += four * d.of[3 * k + b][s]; });
        });
        return [slope](Pack x, Pack y, Pack* c) {
            c[0] = slope[0] * x + slope[1] * y;
            c[1] = broadcast(slope[2]);
        };
    }
};

}  // namespace

void FaceRows::find(const BlockArray<double, 3>& mass)
{
    first.clear();
    hasMass.resize(mass.size() / kLanes);
    const double* m = mass.block(0);
    for (std::size_t row = 0; row < hasMass.size(); ++row) {
        double largest = 0.0;
        for (int l = 0; l < kLanes; ++l) largest = std::max(largest, m[row * kLanes + l]);
        hasMass[row] = largest > 0.0;
        if (hasMass[row]) first.push_back(static_cast<int>(row * kLanes));
    }
}

void BlockPoints::clear()
{
    blockBegin.assign(1, 0);
    cells.clear();
    id.clear();
}

void BlockPoints::find(const Particles& particles, const ParticleOrder& order, const BlockGrid& grid, std::uint32_t idBegin, std::uint32_t idEnd)
{
    clear();
    row.clear();
    for (int block : order.occupied) {
        const int* ranks = order.cells(block);
        for (int rank = 0; rank < kBlockCells; ++rank) {
            const std::size_t first = size();
            for (int s = ranks[rank]; s < ranks[rank + 1]; ++s) {
                if (particles.id[s] < idBegin || particles.id[s] >= idEnd) continue;
                id.push_back(static_cast<int>(particles.id[s] - idBegin));
                row.push_back(s);
            }
            const int i = rank / (kBlockEdge * kBlockEdge), j = rank / kBlockEdge % kBlockEdge, k = rank % kBlockEdge;
            if (size() > first) cells.push_back({tileIndex(i - 1, j - 1, k - 1), static_cast<int>(first)});
        }
        blockBegin.push_back(static_cast<int>(cells.size()));
    }
    cells.push_back({0, static_cast<int>(size())});
    for (AlignedArray<double>& x : inCell) x.resize(size() + kLanes);
    parallelFor(size(), 1024, [&](std::size_t p) {
        for (int a = 0; a < kAxes; ++a) {
            const double inCells = (particles.x[a][row[p]] - grid.origin[a]) * (1.0 / grid.dx);
            inCell[a][p] = inCells - std::floor(inCells);
        }
    });
}

[[gnu::flatten]] void gatherValues(const FaceTile& tile, const BlockPoints& points, std::size_t n, PointArray<3>& u)
{
    gather<ModeSet<1>>(tile, points, n,
                       [&](int a, int s, int count, const Coefficients<1>& found) { storeFirst(u.of[a].data() + s, found[0][0][0], count); });
}

[[gnu::flatten]] void gatherGradients(const FaceTile& tile, const BlockPoints& points, std::size_t n, PointArray<9>& gradient)
{
    gather<ModeSet<4>>(tile, points, n, [&](int a, int s, int count, const Coefficients<2>& found) {
        storeFirst(gradient.of[3 * a].data() + s, found[1][0][0], count);
        storeFirst(gradient.of[3 * a + 1].data() + s, found[0][1][0], count);
        storeFirst(gradient.of[3 * a + 2].data() + s, found[0][0][1], count);
    });
}

void scatterValues(const BlockPoints& points, std::size_t n, const PointArray<3>& f, FaceTile& tile) { scatter<1>(points, n, ValueTerms{f}, tile); }

template <int kDirections>
[[gnu::flatten]] void gatherAlong(const FaceTile& tile, const BlockPoints& points, std::size_t n, const PointArray<3 * kDirections>& d,
                                  PointArray<3 * kDirections>& rates)
{
    gather<ModeSet<4>>(tile, points, n, [&](int a, int s, int count, const Coefficients<2>& found) {
        unroll<kDirections>([&](auto k) {
            const auto direction = [&](int b) { return loadPack(d.of[3 * k + b].data() + s); };
            storeFirst(rates.of[3 * k + a].data() + s, found[1][0][0] * direction(0) + found[0][1][0] * direction(1) + found[0][0][1] * direction(2),
                       count);
        });
    });
}

template <int kDirections>
void scatterAlong(const BlockPoints& points, std::size_t n, const PointArray<3 * kDirections>& d, const PointArray<3 * kDirections>& f,
                  FaceTile& tile)
{
    scatter<2>(points, n, AlongTerms<kDirections>{d, f}, tile);
}

template void gatherAlong<1>(const FaceTile&, const BlockPoints&, std::size_t, const PointArray<3>&, PointArray<3>&);
template void gatherAlong<2>(const FaceTile&, const BlockPoints&, std::size_t, const PointArray<6>&, PointArray<6>&);
template void scatterAlong<1>(const BlockPoints&, std::size_t, const PointArray<3>&, const PointArray<3>&, FaceTile&);
template void scatterAlong<2>(const BlockPoints&, std::size_t, const PointArray<6>&, const PointArray<6>&, FaceTile&);

}  // namespace sim
