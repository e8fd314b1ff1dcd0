#pragma once

#include "sim/core/pack_math.h"
#include "sim/fabric/vec3t.h"
#include "sim/settings.h"

#include <array>

// One triangle of cloth with the three vertices across its edges, for one triangle or a pack of them. Vertices 0, 1, 2 are its own,
// counter-clockwise; 3 + k lies across the edge that faces vertex k.

namespace sim {

inline constexpr int kShellVertices = 6;

/// Least squared ratio of areas det FᵀF, whose logarithm is taken: it is 0 in a triangle without an area [-].
inline constexpr double kLeastStretch = 1.0e-12;
/// Least divisor of what is 0 itself where the divisor is.
inline constexpr double kLeastDivisor = 1.0e-300;

template <class T>
using ShellCorners = std::array<Vec3T<T>, kShellVertices>;

/// Constants of a triangle.
template <class T>
struct ShellRest {
    std::array<T, 3> ru, rw;       ///< derivatives of the shape functions by the two rest coordinates [1/cm]
    T area;                        ///< factor on energies per area: the rest area, times χ where young says how stiff cloth is [cm^2]
    T young, poisson;              ///< E t [dyn/cm] and ν [-], of neo-Hookean membranes
    std::array<T, 4> stretching;   ///< C11 C22 C66 C12 of St Venant-Kirchhoff membranes, by the rest coordinates [dyn/cm]
    std::array<T, 3> hasNeighbor;  ///< 1, or 0 on the boundary [-]
    std::array<T, 3> angle;        ///< dihedral angles at rest [rad]
    std::array<T, 6> bending;      ///< Q00 Q11 Q22 Q01 Q02 Q12: χ energy is ½ θᵀQθ [dyn cm]
};

/// Columns of the 3x2 deformation gradient, and the Green strain with engineering shear [-].
template <class T>
struct MembraneStrain {
    Vec3T<T> u, w;
    std::array<T, 3> green;
};

template <class T>
MembraneStrain<T> membraneStrain(const ShellRest<T>& rest, const ShellCorners<T>& x)
{
    MembraneStrain<T> s;
    s.u = rest.ru[0] * x[0] + rest.ru[1] * x[1] + rest.ru[2] * x[2];
    s.w = rest.rw[0] * x[0] + rest.rw[1] * x[1] + rest.rw[2] * x[2];
    const T half = constant<T>(0.5), one = constant<T>(1.0);
    s.green = {half * (dot(s.u, s.u) - one), half * (dot(s.w, s.w) - one), dot(s.u, s.w)};
    return s;
}

/// Second Piola-Kirchhoff stress times thickness [dyn/cm], and its derivative by the strain as 00 11 22 01 02 12.
template <class T>
struct MembraneStress {
    T energy;  ///< energy per rest area [dyn/cm]
    std::array<T, 3> stress;
    std::array<T, 6> tangent;
};

/// St Venant-Kirchhoff (fabric/shells/README.md, Membrane).
template <class T>
MembraneStress<T> stVenantKirchhoff(const ShellRest<T>& rest, const MembraneStrain<T>& s)
{
    const T half = constant<T>(0.5), zero = constant<T>(0.0);
    const auto& [c11, c22, c66, c12] = rest.stretching;
    MembraneStress<T> m;
    m.stress = {c11 * s.green[0] + c12 * s.green[1], c12 * s.green[0] + c22 * s.green[1], c66 * s.green[2]};
    m.energy = half * (m.stress[0] * s.green[0] + m.stress[1] * s.green[1] + m.stress[2] * s.green[2]);
    m.tangent = {c11, c22, c66, c12, zero, zero};
    return m;
}

inline double logarithm(double v) { return std::log(v); }
inline Pack logarithm(Pack v)
{
    for (int l = 0; l < kLanes; ++l) v[l] = std::log(v[l]);
    return v;
}

/// μ/2 (I₁ − 2 − 2 ln J) + λ/2 (ln J)², plane stress (fabric/shells/README.md, Membrane). The tangent is clamped to be positive.
template <class T>
MembraneStress<T> neoHookean(const ShellRest<T>& rest, const MembraneStrain<T>& s)
{
    const T one = constant<T>(1.0), two = constant<T>(2.0), half = constant<T>(0.5);
    const T mu = rest.young / (two * (one + rest.poisson)), lambda = rest.young * rest.poisson / (one - rest.poisson * rest.poisson);
    const T c00 = two * s.green[0] + one, c11 = two * s.green[1] + one, c01 = s.green[2];
    const T det = largerOf(c00 * c11 - c01 * c01, constant<T>(kLeastStretch));
    const T logJ = half * logarithm(det), perDet = one / det;
    const T p = perDet * c11, q = perDet * c00, r = -(perDet * c01);
    const T pull = lambda * logJ - mu, g = two * largerOf(-pull, constant<T>(0.0));
    MembraneStress<T> m;
    m.energy = half * mu * (c00 + c11 - two - two * logJ) + half * lambda * logJ * logJ;
    m.stress = {mu + pull * p, mu + pull * q, pull * r};
    m.tangent = {lambda * p * p + g * p * p, lambda * q * q + g * q * q, lambda * r * r + half * g * (p * q + r * r),
                 lambda * p * q + g * r * r, lambda * p * r + g * p * r, lambda * q * r + g * q * r};
    return m;
}

/// Positive part of a symmetric 2x2 matrix given as 00, 11, 01.
template <class T>
std::array<T, 3> positivePart(const std::array<T, 3>& s)
{
    const T half = constant<T>(0.5), zero = constant<T>(0.0);
    const T mean = half * (s[0] + s[1]), d = half * (s[0] - s[1]);
    const T radius = squareRoot(d * d + s[2] * s[2]);
    const T high = largerOf(mean + radius, zero), low = largerOf(mean - radius, zero);
    // s = mean + radius · direction, so its positive part has the clamped eigenvalues along the same direction.
    const T share = (high - low) / largerOf(constant<T>(2.0) * radius, constant<T>(kLeastDivisor)), level = half * (high + low);
    return {level + share * d, level - share * d, share * s[2]};
}

/// Dihedral angle across one edge of the triangle [rad] and its derivatives by the vertices across (own side), first and second end,
/// across (other side).
template <class T>
struct Dihedral {
    T sine, cosine;
    std::array<Vec3T<T>, 4> gradient;
};

/// Equations: fabric/shells/README.md, Hinges. x0 own opposite corner, x1 → x2 the edge, x3 the other side's corner.
template <class T>
Dihedral<T> dihedral(const Vec3T<T>& x0, const Vec3T<T>& x1, const Vec3T<T>& x2, const Vec3T<T>& x3)
{
    const T one = constant<T>(1.0);
    const Vec3T<T> edge = x2 - x1, own = cross(edge, x0 - x2), other = -cross(edge, x3 - x2);
    const T length = norm(edge), perOwn = one / norm(own), perOther = one / norm(other);
    const Vec3T<T> along = (one / length) * edge, n = perOwn * own, m = perOther * other;
    Dihedral<T> d;
    d.sine = dot(cross(n, m), along);
    d.cosine = dot(n, m);
    d.gradient[0] = -(length * perOwn) * n;
    d.gradient[3] = -(length * perOther) * m;
    d.gradient[1] = (-dot(along, x0 - x2) * perOwn) * n - (dot(along, x3 - x2) * perOther) * m;
    d.gradient[2] = (dot(along, x0 - x1) * perOwn) * n + (dot(along, x3 - x1) * perOther) * m;
    return d;
}

inline double angleOf(double sine, double cosine) { return std::atan2(sine, cosine); }

/// How the three edges of a triangle are bent.
template <class T>
struct ShellBend {
    std::array<T, 3> angle;                                        ///< 0 on the boundary [rad]
    std::array<std::array<Vec3T<T>, kShellVertices>, 3> gradient;  ///< derivative of each angle by each vertex [1/cm]
};

template <class T>
ShellBend<T> shellBend(const ShellRest<T>& rest, const ShellCorners<T>& x)
{
    ShellBend<T> b;
    for (int k = 0; k < 3; ++k) {
        const int first = (k + 1) % 3, second = (k + 2) % 3;
        const Dihedral<T> d = dihedral(x[k], x[first], x[second], x[3 + k]);
        b.angle[k] = rest.hasNeighbor[k] * angleOf(d.sine, d.cosine);
        for (Vec3T<T>& g : b.gradient[k]) g = Vec3T<T>{constant<T>(0.0), constant<T>(0.0), constant<T>(0.0)};
        b.gradient[k][k] = rest.hasNeighbor[k] * d.gradient[0];
        b.gradient[k][first] = rest.hasNeighbor[k] * d.gradient[1];
        b.gradient[k][second] = rest.hasNeighbor[k] * d.gradient[2];
        b.gradient[k][3 + k] = rest.hasNeighbor[k] * d.gradient[3];
    }
    return b;
}

/// Q v for the six numbers of ShellRest::bending.
template <class T>
std::array<T, 3> timesBending(const std::array<T, 6>& q, const std::array<T, 3>& v)
{
    return {q[0] * v[0] + q[3] * v[1] + q[4] * v[2], q[3] * v[0] + q[1] * v[1] + q[5] * v[2], q[4] * v[0] + q[5] * v[1] + q[2] * v[2]};
}

}  // namespace sim
