#pragma once

#include "sim/core/spline.h"
#include "sim/core/types.h"

#include <array>

// PolyPIC velocity modes (Fu et al. 2017; transfer/README.md, Modes).
//
// Around a particle one velocity component is  u(z) = Σ_r c_r z_x^a z_y^b z_z^c,  z = (node − particle) / dx,  with the
// degrees (a, b, c) of kDegrees[r], the one place that fixes the order of the modes. All lengths here are in cells, so every
// coefficient is a velocity. On the way back the nodes are projected onto the mass-orthogonal factors
// 1, z and g(z) = z² − A z − 1/4, A = r (1 − 4 r²), which depend on the offset r of the particle from its middle node;
// the result is stored in monomials, which do not.

namespace sim {

inline constexpr int kMaxModes = 27;

/// kDegrees[r] = degree of mode r along x, y, z. Prefixes of 1, 4, 8, 11 and 27 modes are PIC, APIC, trilinear,
/// trilinear with the pure squares, and full PolyPIC.
// clang-format off
inline constexpr std::array<std::array<int, 3>, kMaxModes> kDegrees = {{
    {0, 0, 0},
    {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
    {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1},
    {2, 0, 0}, {0, 2, 0}, {0, 0, 2},
    {2, 2, 0}, {0, 2, 2}, {2, 0, 2}, {2, 2, 2},
    {2, 1, 0}, {2, 0, 1}, {2, 1, 1},
    {1, 2, 0}, {0, 2, 1}, {1, 2, 1},
    {1, 0, 2}, {0, 1, 2}, {1, 1, 2},
    {2, 2, 1}, {2, 1, 2}, {1, 2, 2},
}};
// clang-format on

/// Number of the mode of degrees (a, b, c).
constexpr int modeOfDegrees(int a, int b, int c)
{
    for (int r = 0; r < kMaxModes; ++r)
        if (kDegrees[r][0] == a && kDegrees[r][1] == b && kDegrees[r][2] == c) return r;
    return -1;
}

/// Highest degree per axis among the first `modes` modes: 0, 1 or 2.
constexpr int highestDegree(int modes) { return modes == 1 ? 0 : modes <= 8 ? 1 : 2; }

/// Rows a particle stores for N_r = `modes`: the smallest prefix that has a fast kernel and that the monomial form of every
/// gathered mode stays inside. (g0 g1, say, has monomials down to x y and x² y: from N_r = 12 on all 27 are stored.)
constexpr int storedModes(int modes) { return modes <= 1 ? 1 : modes <= 4 ? 4 : modes <= 8 ? 8 : modes <= 11 ? 11 : 27; }

/// Weighted mean of each monomial over the stencil: (1/4) per square, 0 with an odd power; the same at every offset.
/// Σ_r kMeanOfMode[r] c_r is the particle's velocity.
inline constexpr std::array<double, kMaxModes> kMeanOfMode = [] {
    std::array<double, kMaxModes> mean{};
    for (int r = 0; r < kMaxModes; ++r) {
        mean[r] = 1.0;
        for (int degree : kDegrees[r]) mean[r] *= degree == 0 ? 1.0 : degree == 1 ? 0.0 : 0.25;
    }
    return mean;
}();

/// Variance of the quadratic B-spline [cells^2].
inline constexpr double kSplineVariance = 0.25;

/// The quadratic B-spline stencil of one particle along one axis; nodes n = 0, 1, 2.
struct Basis1D {
    /// @param offset  particle − middle node, in cells, in [−1/2, 1/2]
    explicit Basis1D(double offset) : skew(offset * (1.0 - 4.0 * offset * offset))
    {
        splineWeights(offset, weight);
        for (int n = 0; n < 3; ++n) {
            z[n] = n - 1 - offset;
            project[n] = {weight[n], 4.0 * weight[n] * z[n], n == 1 ? -1.0 : 0.5};
        }
    }

    std::array<double, 3> weight;                  ///< B-spline weight of node n; sums to 1
    std::array<double, 3> z;                       ///< node − particle, in cells
    std::array<std::array<double, 3>, 3> project;  ///< project[n][d]: share of node n in the orthogonal coefficient of degree d
    double skew;                                   ///< A: g(z) = z² − A z − 1/4
};

using Basis = std::array<Basis1D, 3>;

/// The coefficients of one velocity component, orthogonal or monomial; unused ones are 0.
using Modes = std::array<double, kMaxModes>;

/// u at a node of the stencil, each coordinate 0..2, from monomial modes.
double evaluateModes(const Basis& basis, const Vec3i& node, const Modes& c);

/// u at z [cells] from the particle, from monomial modes.
double evaluateModes(const Vec3& z, const Modes& c);

/// Add the share of a node of the stencil, moving with u, to the first `modes` orthogonal coefficients.
void projectOntoModes(const Basis& basis, const Vec3i& node, double u, int modes, Modes& c);

/// Orthogonal coefficients to monomial ones: per axis (c0, c1, c2) → (c0 − c2/4, c1 − A c2, c2). Modes that a truncated set
/// does not hold are filled in where a held one needs them.
Modes toMonomials(const Basis& basis, const Modes& orthogonal);

/// The inverse: monomials to orthogonal coefficients at the offset of `basis`.
Modes toOrthogonal(const Basis& basis, const Modes& monomial);

/// Σ_r kMeanOfMode[r] c_r: the particle's velocity component.
double meanOf(const Modes& monomial);

}  // namespace sim
