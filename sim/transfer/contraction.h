#pragma once

#include "sim/core/simd.h"
#include "sim/core/spline.h"
#include "sim/transfer/mode_set.h"
#include "sim/transfer/tile.h"

// The arithmetic of G2P for 8 particles of one cell at once (transfer/README.md, Kernels): operators from the particles' places, contraction of a
// tile of faces with them, conversion between orthogonal coefficients and monomials, energy of the modes.

namespace sim {

/// Share of each node of a row in the coefficients of degree 0, 1, 2 along one axis, for 8 particles of one cell. Faces of the
/// particle's own axis are four in a row, of which one has no weight; the other two axes have three.
template <int kFactors>
struct Operators {
    Pack center[3][kFactors], face[4][kFactors];
    Pack centerOffset, faceOffset;  ///< particle − middle node, in cells
};

/// kFold: all 27 modes are gathered, and the conversion to monomials is folded in: op0 − op2/4, op1 − A op2. With fewer it must
/// follow the truncation.
template <int kFactors, bool kFold>
[[gnu::always_inline]] inline void setOperators(Pack xi, Operators<kFactors>& op)
{
    const auto store = [&](Pack* out, Pack weight, Pack z, Pack second, Pack skew) {
        out[0] = weight;
        if constexpr (kFactors > 1) out[1] = 4.0 * weight * z;
        if constexpr (kFactors > 2) {
            out[2] = second;
            if constexpr (kFold) {
                out[0] -= 0.25 * second;
                out[1] -= skew * second;
            }
        }
    };
    constexpr double kSecond[3] = {0.5, -1.0, 0.5};
    Pack w[3];
    const Pack r = xi - 0.5;
    op.centerOffset = r;
    splineWeights(r, w);
    unroll<3>([&](auto n) { store(op.center[n], w[n], (n - 1.0) - r, broadcast(kSecond[n]), r * (1.0 - 4.0 * r * r)); });

    const PackMask upper = xi >= 0.5;
    const Pack rf = select(upper, xi - 1.0, xi), zero = broadcast(0.0);
    op.faceOffset = rf;
    splineWeights(rf, w);
    unroll<4>([&](auto n) {
        const Pack lowerWeight = n < 3 ? w[n % 3] : zero, upperWeight = n > 0 ? w[(n + 2) % 3] : zero;
        const Pack second = select(upper, broadcast(n > 0 ? kSecond[(n + 2) % 3] : 0.0), broadcast(n < 3 ? kSecond[n % 3] : 0.0));
        store(op.face[n], select(upper, upperWeight, lowerWeight), (n - 1.0) - xi, second, rf * (1.0 - 4.0 * rf * rf));
    });
}

/// Coefficients of one component, c[a][b][c] for the degrees along x, y, z; only those of the set are computed.
template <int kFactors>
using Coefficients = Pack[kFactors][kFactors][kFactors];

/// Degrees (f, p, q) along the face's axis and the two that follow it → does the set hold that mode?
template <int kAxis, class Set>
constexpr bool hasRotated(int f, int p, int q)
{
    return kAxis == 0 ? Set::has(f, p, q) : kAxis == 1 ? Set::has(q, f, p) : Set::has(p, q, f);
}

/// Contract the 4×3×3 faces around a cell with the operators, the face's own axis first.
template <int kAxis, class Set>
[[gnu::always_inline]] inline void contract(const double* node, const Operators<Set::kFactors>* op, Coefficients<Set::kFactors>& out)
{
    constexpr int kFactors = Set::kFactors, kP = (kAxis + 1) % 3, kQ = (kAxis + 2) % 3;
    constexpr int kStride[3] = {1, kTileStrideY, kTileStrideZ};
    Pack sum[kFactors][kFactors][kFactors];
    unroll<3>([&](auto q) {
        Pack plane[kFactors][kFactors];
        unroll<3>([&](auto p) {
            Pack row[kFactors];
            unroll<4>([&](auto n) {
                const double u = node[n * kStride[kAxis] + p * kStride[kP] + q * kStride[kQ]];
                unroll<kFactors>([&](auto f) {
                    if constexpr (n == 0) row[f] = u * op[kAxis].face[n][f];
                    else row[f] += u * op[kAxis].face[n][f];
                });
            });
            unroll<kFactors>([&](auto f) {
                unroll<kFactors>([&](auto dp) {
                    if constexpr (hasRotated<kAxis, Set>(f, dp, 0)) {
                        if constexpr (p == 0) plane[f][dp] = row[f] * op[kP].center[p][dp];
                        else plane[f][dp] += row[f] * op[kP].center[p][dp];
                    }
                });
            });
        });
        unroll<kFactors>([&](auto f) {
            unroll<kFactors>([&](auto dp) {
                unroll<kFactors>([&](auto dq) {
                    if constexpr (hasRotated<kAxis, Set>(f, dp, dq)) {
                        if constexpr (q == 0) sum[f][dp][dq] = plane[f][dp] * op[kQ].center[q][dq];
                        else sum[f][dp][dq] += plane[f][dp] * op[kQ].center[q][dq];
                    }
                });
            });
        });
    });
    unroll<kFactors>([&](auto f) {
        unroll<kFactors>([&](auto dp) {
            unroll<kFactors>([&](auto dq) {
                if constexpr (hasRotated<kAxis, Set>(f, dp, dq)) {
                    if constexpr (kAxis == 0) out[f][dp][dq] = sum[f][dp][dq];
                    else if constexpr (kAxis == 1) out[dq][f][dp] = sum[f][dp][dq];
                    else out[dp][dq][f] = sum[f][dp][dq];
                }
            });
        });
    });
}

/// Call f(r, a, b, c) for each mode of the set with its degrees, all compile-time constants.
template <int kModes, class F>
[[gnu::always_inline]] inline void forEachMode(F&& f)
{
    unroll<kModes>([&](auto r) {
        constexpr auto kDegree = kDegrees[r];
        f(r, std::integral_constant<int, kDegree[0]>{}, std::integral_constant<int, kDegree[1]>{}, std::integral_constant<int, kDegree[2]>{});
    });
}

/// Zero the modes from N_r on in a set that stores more than is gathered.
template <int kModes, int kFactors>
[[gnu::always_inline]] inline void truncate(int modes, Coefficients<kFactors>& c)
{
    forEachMode<kModes>([&](auto r, auto a, auto b, auto d) {
        if (r >= modes) c[a][b][d] = broadcast(0.0);
    });
}

template <class Set>
[[gnu::always_inline]] inline Pack meanVelocity(const Coefficients<Set::kFactors>& c)
{
    Pack v = c[0][0][0];
    if constexpr (Set::kFactors > 2)
        unroll<3>([&](auto a) {
            unroll<3>([&](auto b) {
                unroll<3>([&](auto d) {
                    constexpr bool kEven = a != 1 && b != 1 && d != 1 && a + b + d > 0;
                    if constexpr (kEven && Set::has(a, b, d)) v += (a + b + d == 2 ? 0.25 : a + b + d == 4 ? 0.0625 : 0.015625) * c[a][b][d];
                });
            });
        });
    return v;
}

/// Along one axis (c0, c1, c2) → (c0 + s c2/4, c1 + s A c2, c2): s = −1 to monomials, +1 back.
template <class Set>
[[gnu::always_inline]] inline void convert(double s, const Pack (&skew)[3], Coefficients<Set::kFactors>& c)
{
    if constexpr (Set::kFactors > 2) {
        unroll<3>([&](auto u) {
            unroll<3>([&](auto w) {
                if constexpr (Set::has(2, u, w)) {
                    c[0][u][w] += (0.25 * s) * c[2][u][w];
                    c[1][u][w] += s * skew[0] * c[2][u][w];
                }
            });
        });
        unroll<3>([&](auto u) {
            unroll<3>([&](auto w) {
                if constexpr (Set::has(u, 2, w)) {
                    c[u][0][w] += (0.25 * s) * c[u][2][w];
                    c[u][1][w] += s * skew[1] * c[u][2][w];
                }
            });
        });
        unroll<3>([&](auto u) {
            unroll<3>([&](auto w) {
                if constexpr (Set::has(u, w, 2)) {
                    c[u][w][0] += (0.25 * s) * c[u][w][2];
                    c[u][w][1] += s * skew[2] * c[u][w][2];
                }
            });
        });
    }
}

/// α²|e|² of a particle's velocities, with the symmetric part e of the gradient and the variance α² of the B-spline (strainEnergy), from the
/// orthogonal coefficients of its components.
template <class Set>
[[gnu::always_inline]] inline Pack strainSquare(const Coefficients<Set::kFactors> (&c)[3])
{
    Pack sum = broadcast(0.0);
    unroll<3>([&](auto a) {
        constexpr int b = (a + 1) % 3;
        const auto slope = [&](int component, int along) { return c[component][along == 0][along == 1][along == 2]; };
        const Pack stretch = slope(a, a), shear = slope(a, b) + slope(b, a);
        sum += stretch * stretch + 0.5 * shear * shear;
    });
    return kSplineVariance * sum;
}

/// The part of ⟨U², 1⟩ that the modes above the mean hold at the offsets r (liquid/README.md, Energy), from orthogonal coefficients: each square
/// times the norms of its three factors, gathered axis by axis.
template <class Set>
[[gnu::always_inline]] inline Pack modalSquare(const Pack (&r)[3], const Coefficients<Set::kFactors>& c)
{
    constexpr int kFactors = Set::kFactors;
    Pack norm[3][3];
    unroll<3>([&](auto a) {
        const Pack rr = r[a] * r[a];
        norm[a][1] = broadcast(0.25);
        norm[a][2] = 0.1875 + rr * (-1.75 + rr * (5.0 - 4.0 * rr));
    });
    const auto weighted = [&](int axis, int degree, Pack v) { return degree == 0 ? v : norm[axis][degree] * v; };
    Pack sum = broadcast(0.0);
    unroll<kFactors>([&](auto a) {
        Pack plane = broadcast(0.0);
        unroll<kFactors>([&](auto b) {
            Pack row = broadcast(0.0);
            unroll<kFactors>([&](auto d) {
                if constexpr (Set::has(a, b, d) && a + b + d > 0) row += weighted(2, d, c[a][b][d] * c[a][b][d]);
            });
            if constexpr (Set::has(a, b, 0)) plane += weighted(1, b, row);
        });
        sum += weighted(0, a, plane);
    });
    return sum;
}

}  // namespace sim
