#pragma once

#include "sim/fabric/parallel_transport.h"

#include <array>

// Discrete elastic rods (Bergou et al. 2008, 2010; fabric/rods/README.md, Kinematics): one edge, and one interior vertex with its two edges, for
// one rod or for a pack of rods. e is the edge before the vertex, f the edge after it.

namespace sim {

/// One edge of a rod in its present place.
template <class T>
struct RodEdge {
    T length;            ///< [cm]
    Vec3T<T> tangent;    ///< [-]
    Vec3T<T> reference;  ///< first axis of the reference frame [-]
    Vec3T<T> m1, m2;     ///< axes of the material frame: along the half axes a and b of the section [-]
};

/// Derivatives of a quantity by the 11 unknowns of an interior vertex: x before, θ_e, x, θ_f, x after.
template <class T>
using RodGradient = std::array<T, 11>;

inline constexpr int kRodUnknowns = 11;

/// Least 1 + t_e · t_f that is divided by: it is 0 where a yarn folds back onto itself [-].
inline constexpr double kLeastFold = 1.0e-12;

/// How a rod is bent and twisted at an interior vertex.
template <class T>
struct RodStrain {
    std::array<T, 4> curvature;  ///< curvatures by the edge before, κb·m2_e and −κb·m1_e, and by the edge after, κb·m2_f and −κb·m1_f [-]
    std::array<RodGradient<T>, 4> curvatureGradient;
    RodGradient<T> twistGradient;  ///< gradient of m = reference twist + θ_f − θ_e
};

/// Equations: fabric/rods/README.md, Kinematics; fabric/rods/README.md, Gradients. The gradients are those of frames that follow by parallel
/// transport from where they are now.
template <class T>
RodStrain<T> rodStrain(const RodEdge<T>& e, const RodEdge<T>& f)
{
    const T one = constant<T>(1.0), zero = constant<T>(0.0), least = constant<T>(kLeastFold);
    const T inverse = one / largerOf(one + dot(e.tangent, f.tangent), least);
    const Vec3T<T> binormal = (constant<T>(2.0) * inverse) * cross(e.tangent, f.tangent);
    const Vec3T<T> middle = inverse * (e.tangent + f.tangent);
    const T perE = one / e.length, perF = one / f.length;
    const std::array<Vec3T<T>, 4> axis = {e.m2, e.m1, f.m2, f.m1};
    constexpr std::array<double, 4> kSign = {1.0, -1.0, 1.0, -1.0};

    RodStrain<T> s;
    for (int k = 0; k < 4; ++k) {
        const T sign = constant<T>(kSign[k]);
        s.curvature[k] = sign * dot(binormal, axis[k]);
        const Vec3T<T> d = (sign * constant<T>(2.0) * inverse) * axis[k];
        const Vec3T<T> byE = perE * (cross(f.tangent, d) - s.curvature[k] * middle);
        const Vec3T<T> byF = perF * (-cross(e.tangent, d) - s.curvature[k] * middle);
        for (int a = 0; a < 3; ++a) {
            s.curvatureGradient[k][a] = -byE[a];
            s.curvatureGradient[k][4 + a] = byE[a] - byF[a];
            s.curvatureGradient[k][8 + a] = byF[a];
        }
        s.curvatureGradient[k][3] = zero;
        s.curvatureGradient[k][7] = zero;
    }
    s.curvatureGradient[0][3] = s.curvature[1];
    s.curvatureGradient[1][3] = -s.curvature[0];
    s.curvatureGradient[2][7] = s.curvature[3];
    s.curvatureGradient[3][7] = -s.curvature[2];

    const T half = constant<T>(0.5);
    for (int a = 0; a < 3; ++a) {
        const T before = half * perE * binormal[a], after = half * perF * binormal[a];
        s.twistGradient[a] = -before;
        s.twistGradient[4 + a] = before - after;
        s.twistGradient[8 + a] = after;
    }
    s.twistGradient[3] = -one;
    s.twistGradient[7] = one;
    return s;
}

template <class T>
using Block = std::array<std::array<T, 3>, 3>;

/// Second derivatives of m by the edges e and f (fabric/rods/README.md, Hessian; Bergou et al. 2010).
template <class T>
struct TwistCurvature {
    Block<T> ee, ef, ff;  ///< [1/cm^2]; ef: a row for each component of e
};

template <class T>
TwistCurvature<T> twistCurvature(const RodEdge<T>& e, const RodEdge<T>& f)
{
    const T one = constant<T>(1.0), least = constant<T>(kLeastFold), quarter = constant<T>(0.25);
    const T inverse = one / largerOf(one + dot(e.tangent, f.tangent), least);
    const Vec3T<T> binormal = (constant<T>(2.0) * inverse) * cross(e.tangent, f.tangent);
    const Vec3T<T> middle = inverse * (e.tangent + f.tangent);
    const Vec3T<T> onE = (-quarter / (e.length * e.length)) * (e.tangent + middle);
    const Vec3T<T> onF = (-quarter / (f.length * f.length)) * (f.tangent + middle);
    const T both = constant<T>(0.5) / (e.length * f.length);
    const Vec3T<T> turn = (constant<T>(2.0) * inverse) * e.tangent;
    TwistCurvature<T> c;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            c.ee[a][b] = binormal[a] * onE[b] + onE[a] * binormal[b];
            c.ff[a][b] = binormal[a] * onF[b] + onF[a] * binormal[b];
            c.ef[a][b] = -both * binormal[a] * middle[b];
        }
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, third = (a + 2) % 3;
        c.ef[a][b] -= both * turn[third];
        c.ef[b][a] += both * turn[third];
    }
    return c;
}

}  // namespace sim
