#include "sim/fabric/grid/block_points.h"

namespace sim {

namespace {

[[gnu::always_inline]] inline HalfPack load(const double* p)
{
    HalfPack v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

[[gnu::always_inline]] inline double sum(HalfPack v)
{
    return (v[0] + v[1]) + (v[2] + v[3]);
}

}  // namespace

PointWeights::PointWeights(const PointPlace& place)
{
    constexpr HalfPack kA = {0.5, -1.0, 0.5, 0.0}, kB = {-0.5, 0.0, 0.5, 0.0}, kC = {0.125, 0.75, 0.125, 0.0},
                       kNode = {-1.0, 0.0, 1.0, 0.0};
    for (int kind = 0; kind < 2; ++kind) {
        for (int a = 0; a < kAxes; ++a) {
            const bool upper = kind == 1 && place.inCell[a] >= 0.5;
            offset[kind][a] = place.inCell[a] - (kind == 0 ? 0.5 : upper ? 1.0 : 0.0);
            node[kind][a] = place.cell[a] - 1 + (upper ? 1 : 0);
        }
        const auto weights = [&](double r) { return (kA * r + kB) * r + kC; };
        x[kind] = weights(offset[kind][0]);
        y[kind] = weights(offset[kind][1]);
        z[kind] = weights(offset[kind][2]);
        zx[kind] = x[kind] * (kNode - offset[kind][0]);
    }
}

PointWeights PointWeights::squared() const
{
    PointWeights w = *this;
    for (int kind = 0; kind < 2; ++kind) {
        w.x[kind] *= x[kind];
        w.y[kind] *= y[kind];
        w.z[kind] *= z[kind];
    }
    return w;
}

void BlockPoints::clear()
{
    begin.assign(1, 0);
    id.clear();
    place.clear();
}

Vec3 interpolate(const FaceTile& tile, const PointWeights& w)
{
    Vec3 u;
    for (int a = 0; a < kAxes; ++a) {
        const double* from = tile.v[a] + w.first(a);
        const HalfPack wy = w.y[a == 1], wz = w.z[a == 2];
        HalfPack rows{};
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) rows += (wy[j] * wz[k]) * load(from + j * kTileStrideY + k * kTileStrideZ);
        u[a] = sum(rows * w.x[a == 0]);
    }
    return u;
}

void distribute(const PointWeights& w, const Vec3& f, FaceTile& tile)
{
    for (int a = 0; a < kAxes; ++a) {
        double* to = tile.v[a] + w.first(a);
        const HalfPack wy = w.y[a == 1], wz = w.z[a == 2];
        const HalfPack row = f[a] * w.x[a == 0];
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) {
                double* at = to + j * kTileStrideY + k * kTileStrideZ;
                const HalfPack v = load(at) + (wy[j] * wz[k]) * row;
                std::memcpy(at, &v, sizeof v);
            }
    }
}

Mat3 gradientAt(const FaceTile& tile, const PointWeights& w)
{
    Mat3 g;
    for (int a = 0; a < kAxes; ++a) {
        const double* from = tile.v[a] + w.first(a);
        const HalfPack wy = w.y[a == 1], wz = w.z[a == 2];
        const double ry = w.offset[a == 1][1], rz = w.offset[a == 2][2];
        HalfPack rows{}, rowsY{}, rowsZ{};
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) {
                const HalfPack row = (wy[j] * wz[k]) * load(from + j * kTileStrideY + k * kTileStrideZ);
                rows += row;
                rowsY += (j - 1 - ry) * row;
                rowsZ += (k - 1 - rz) * row;
            }
        const HalfPack& wx = w.x[a == 0];
        g(a, 0) = 4.0 * sum(rows * w.zx[a == 0]);
        g(a, 1) = 4.0 * sum(rowsY * wx);
        g(a, 2) = 4.0 * sum(rowsZ * wx);
    }
    return g;
}

void distributeGradient(const PointWeights& w, const Mat3& t, FaceTile& tile)
{
    for (int a = 0; a < kAxes; ++a) {
        double* to = tile.v[a] + w.first(a);
        const HalfPack wy = w.y[a == 1], wz = w.z[a == 2];
        const double ry = w.offset[a == 1][1], rz = w.offset[a == 2][2];
        const HalfPack alongX = (4.0 * t(a, 0)) * w.zx[a == 0], wx = 4.0 * w.x[a == 0];
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) {
                double* at = to + j * kTileStrideY + k * kTileStrideZ;
                const HalfPack v =
                    load(at) + (wy[j] * wz[k]) * (alongX + (t(a, 1) * (j - 1 - ry) + t(a, 2) * (k - 1 - rz)) * wx);
                std::memcpy(at, &v, sizeof v);
            }
    }
}

void distributeSquare(const PointWeights& w, int axis, const Mat3& b, FaceTile& tile)
{
    const int a = axis;
    double* to = tile.v[a] + w.first(a);
    const HalfPack wy = w.y[a == 1], wz = w.z[a == 2];
    const HalfPack wx = w.x[a == 0], zx = w.zx[a == 0];
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) {
            const double y = j - 1 - w.offset[a == 1][1], z = k - 1 - w.offset[a == 2][2], weight = 4.0 * wy[j] * wz[k];
            const double mixed = 2.0 * (b(0, 1) * y + b(0, 2) * z),
                         rest = b(1, 1) * y * y + 2.0 * b(1, 2) * y * z + b(2, 2) * z * z;
            double* at = to + j * kTileStrideY + k * kTileStrideZ;
            const HalfPack v = load(at) + (weight * weight) * (b(0, 0) * zx * zx + mixed * zx * wx + rest * wx * wx);
            std::memcpy(at, &v, sizeof v);
        }
}

}  // namespace sim
