#pragma once

#include "sim/fabric/vec3t.h"

#include <array>

namespace sim {

// Response of an active contact element to a motion of its surroundings (fabric/grid/README.md, Contact law), for one element or a pack of them.
// Its directions across the fabric d are rates by the velocity gradient G on the grid, those in the mesh by the
// corners; the mesh turning one way acts as d turning the other way. All that the grid knows of an element is how it
// carries d, and the stress that d answers with: what the element gives to the faces is the stress times d.

/// 3x3, by rows.
template <class T>
using Rows = std::array<Vec3T<T>, 3>;

template <class T>
Vec3T<T> operator*(const Rows<T>& m, const Vec3T<T>& v)
{
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// Σ_a v_a m_a: the transpose of m times v.
template <class T>
Vec3T<T> transposedTimes(const Rows<T>& m, const Vec3T<T>& v)
{
    return v.x * m[0] + v.y * m[1] + v.z * m[2];
}

/// xx, yy, zz, xy, yz, zx of a symmetric 3x3.
template <class T>
struct Symmetric {
    T xx, yy, zz, xy, yz, zx;

    friend Vec3T<T> operator*(const Symmetric& m, const Vec3T<T>& v)
    {
        return {m.xx * v.x + m.xy * v.y + m.zx * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z, m.zx * v.x + m.yz * v.y + m.zz * v.z};
    }
};

/// Angular velocity of an edge whose ends move apart at `along`.
template <class T>
Vec3T<T> angularVelocityOfEdge(const Vec3T<T>& reciprocal, const Vec3T<T>& along)
{
    return cross(reciprocal, along);
}
/// Angular velocity of a face's normal, where the edges from its first corner change at u1 and u2.
template <class T>
Vec3T<T> angularVelocityOfNormal(const Vec3T<T>& normal, const std::array<Vec3T<T>, 2>& reciprocal, const Vec3T<T>& u1, const Vec3T<T>& u2)
{
    return cross(dot(normal, u1) * reciprocal[0] + dot(normal, u2) * reciprocal[1], normal);
}

template <class T, int kCount>
using Triples = std::array<Vec3T<T>, kCount>;

/// An edge of a yarn.
template <class T>
struct EdgeContact {
    static constexpr int kCorners = 2, kDirections = 2;
    using Across = Triples<T, kDirections>;  ///< G d, or stresses ∂E/∂d [erg]
    using Corners = Triples<T, kCorners>;

    Across d;
    Vec3T<T> reciprocal;    ///< direction of the edge over its length [1/cm]
    Symmetric<T> k00, k11;  ///< ∂²E/∂d² [erg]
    Rows<T> k01;

    /// Change of the stress when the surroundings move: G carries d, the corners move by u.
    Across change(const Across& rates, const Corners& u) const
    {
        const Vec3T<T> turn = angularVelocityOfEdge(reciprocal, u[1] - u[0]);
        const Vec3T<T> first = rates[0] - cross(turn, d[0]), second = rates[1] - cross(turn, d[1]);
        return {k00 * first + k01 * second, transposedTimes(k01, first) + k11 * second};
    }
    /// What a stress does to the corners: transpose of how they turn d.
    Corners nodalResponse(const Across& stress) const
    {
        const Vec3T<T> lever = cross(cross(stress[0], d[0]) + cross(stress[1], d[1]), reciprocal);
        return {-lever, lever};
    }
};

/// A face of cloth.
template <class T>
struct FaceContact {
    static constexpr int kCorners = 3, kDirections = 1;
    using Across = Triples<T, kDirections>;
    using Corners = Triples<T, kCorners>;

    Across d;
    Vec3T<T> normal;
    std::array<Vec3T<T>, 2> reciprocal;  ///< in the plane, of the two edges from the first corner [1/cm]
    Symmetric<T> k;

    Across change(const Across& rates, const Corners& u) const
    {
        return {k * (rates[0] - cross(angularVelocityOfNormal(normal, reciprocal, u[1] - u[0], u[2] - u[0]), d[0]))};
    }
    Corners nodalResponse(const Across& stress) const
    {
        const Vec3T<T> lever = cross(cross(stress[0], d[0]), normal);
        const Vec3T<T> second = -(dot(lever, reciprocal[0]) * normal), third = -(dot(lever, reciprocal[1]) * normal);
        return {-(second + third), second, third};
    }
};

}  // namespace sim
