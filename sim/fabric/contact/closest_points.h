#pragma once

#include "sim/fabric/contact/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace sim::contact {

/// What two primitives are: their four vertices are two and two, or one and three.
enum class PairKind { EdgeEdge, VertexFace };

/// The nearest points of two primitives.
/// Edges 0-1 and 2-3: the points (1 − p) x0 + p x1 and (1 − q) x2 + q x3. Vertex 0 and face 1-2-3: x0 and (1 − p − q) x1 + p x2 + q x3.
template <class T>
struct Closest {
    T p, q;               ///< [0..1]
    Vec3T<T> separation;  ///< vector from the nearest point of the second to that of the first [cm]
};

/// Shares of the four vertices in the separation; those of the second primitive are negative, all sum to zero.
inline std::array<double, 4> pairWeights(PairKind kind, double p, double q)
{
    if (kind == PairKind::EdgeEdge) return {1.0 - p, p, q - 1.0, -q};
    return {1.0, p + q - 1.0, -p, -q};
}

namespace detail {

inline double choose(bool mask, double a, double b) { return mask ? a : b; }
[[gnu::always_inline]] inline Pack choose(PackMask mask, Pack a, Pack b) { return select(mask, a, b); }

template <class T>
using Mask = std::conditional_t<std::is_same_v<T, double>, bool, PackMask>;

template <class T>
[[gnu::always_inline]] inline T unitClamp(T v)
{
    const T zero = T{}, one = T{} + 1.0;
    v = choose(v > zero, v, zero);
    return choose(v < one, v, one);
}

/// Squares of lengths below this are 0: nothing is divided by them [cm^2].
inline constexpr double kNoLength = 1.0e-200;
/// sin² of the angle below which edges are parallel, and triangles lines [-].
inline constexpr double kParallel = 1.0e-12;

template <class T>
[[gnu::always_inline]] inline T positive(T v)
{
    const T tiny = T{} + kNoLength;
    return choose(v > tiny, v, tiny);
}

}  // namespace detail

/// Source: Ericson 2005, "Real-Time Collision Detection", 5.1.9; of parallel edges the middle of the overlap, an edge without length is a
/// point.
template <class T>
[[gnu::always_inline]] inline Closest<T> closestOnEdges(const std::array<Vec3T<T>, 4>& x)
{
    using namespace detail;
    const Vec3T<T> first = x[1] - x[0], second = x[3] - x[2], apart = x[0] - x[2];
    const T aa = positive(dot(first, first)), bb = positive(dot(second, second)), ab = dot(first, second);
    const T a = dot(first, apart), b = dot(second, apart);
    const T across = aa * bb - ab * ab, perLength = 1.0 / aa;
    const T atStart = unitClamp(T(-a * perLength)), atEnd = unitClamp(T((ab - a) * perLength));
    T p = choose(across > kParallel * aa * bb, unitClamp(T((ab * b - a * bb) / across)), T(0.5 * (atStart + atEnd)));
    const T zero = T{}, one = T{} + 1.0;
    T q = (ab * p + b) / bb;
    p = choose(q < zero, atStart, choose(q > one, atEnd, p));
    q = unitClamp(q);
    return {p, q, apart + p * first - q * second};
}

/// The foot of the perpendicular where it falls into the triangle, else the nearest point of the three edges.
template <class T>
[[gnu::always_inline]] inline Closest<T> closestOnFace(const std::array<Vec3T<T>, 4>& x)
{
    using namespace detail;
    const Vec3T<T> e1 = x[2] - x[1], e2 = x[3] - x[1], e3 = x[3] - x[2], apart = x[0] - x[1], apart3 = x[0] - x[2];
    const T a = positive(dot(e1, e1)), b = positive(dot(e2, e2)), ab = dot(e1, e2);
    const T f1 = dot(apart, e1), f2 = dot(apart, e2);
    const T zero = T{}, one = T{} + 1.0;

    T p = unitClamp(T(f1 / a)), q = zero;
    Vec3T<T> separation = apart - p * e1;
    T nearest = dot(separation, separation);
    const auto take = [&](T otherP, T otherQ, auto&& better) __attribute__((always_inline))
    {
        const Vec3T<T> s = apart - otherP * e1 - otherQ * e2;
        const T d = dot(s, s);
        const Mask<T> chosen = better(d);
        p = choose(chosen, otherP, p), q = choose(chosen, otherQ, q), nearest = choose(chosen, d, nearest);
        separation = {choose(chosen, s.x, separation.x), choose(chosen, s.y, separation.y), choose(chosen, s.z, separation.z)};
    };
    const auto nearer = [&](T d) { return Mask<T>(d < nearest); };
    take(zero, unitClamp(T(f2 / b)), nearer);
    const T along = unitClamp(T(dot(apart3, e3) / positive(dot(e3, e3))));
    take(one - along, along, nearer);

    const T area = a * b - ab * ab;  // four times the square of the triangle's
    const T insideP = (b * f1 - ab * f2) / area, insideQ = (a * f2 - ab * f1) / area;
    take(insideP, insideQ,
         [&](T) { return Mask<T>((area > kParallel * a * b) & (insideP >= zero) & (insideQ >= zero) & (insideP + insideQ <= one)); });
    return {p, q, separation};
}

template <class T>
[[gnu::always_inline]] inline Closest<T> closestPoints(PairKind kind, const std::array<Vec3T<T>, 4>& x)
{
    return kind == PairKind::EdgeEdge ? closestOnEdges(x) : closestOnFace(x);
}

/// How far the first k and the other 4 − k vertices of a pair move against each other at most, k = 2 for edges and 1 for a vertex: the
/// distance can't change by more. Common motion is left out. Displacements and result in [cm].
template <class T, class Root, class Greater>
[[gnu::always_inline]] inline T relativeMotion(PairKind kind, const std::array<Vec3T<T>, 4>& u, Root&& root, Greater&& greater)
{
    const auto from = [&](int a, const Vec3T<T>& middle) __attribute__((always_inline))
    {
        const Vec3T<T> d = u[a] - middle;
        return dot(d, d);
    };
    const T half = T{} + 0.5, third = T{} + 1.0 / 3.0;
    if (kind == PairKind::EdgeEdge) {
        const Vec3T<T> middle = T(0.5 * half) * ((u[0] + u[1]) + (u[2] + u[3]));
        return root(greater(from(0, middle), from(1, middle))) + root(greater(from(2, middle), from(3, middle)));
    }
    const Vec3T<T> middle = half * (u[0] + third * (u[1] + u[2] + u[3]));
    return root(from(0, middle)) + root(greater(from(1, middle), greater(from(2, middle), from(3, middle))));
}

inline double relativeMotion(PairKind kind, const std::array<Vec3T<double>, 4>& u)
{
    return relativeMotion(
        kind, u, [](double v) { return std::sqrt(v); }, [](double a, double b) { return std::max(a, b); });
}

[[gnu::always_inline]] inline Pack relativeMotion(PairKind kind, const std::array<Vec3T<Pack>, 4>& u)
{
    return relativeMotion(
        kind, u, [](Pack v) { return sqrtPack(v); }, [](Pack a, Pack b) { return maxPack(a, b); });
}

/// Largest gap, over the axes, between the boxes around the two sides while they move against each other: they don't come nearer [cm].
inline double sweptGap(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u)
{
    const auto box = [&](const std::array<Vec3, 4>& values, std::size_t begin, std::size_t end) {
        std::array<Vec3, 2> b = {values[begin], values[begin]};
        for (std::size_t c = begin + 1; c < end; ++c) b = {b[0].cwiseMin(values[c]).eval(), b[1].cwiseMax(values[c]).eval()};
        return b;
    };
    const std::size_t second = kind == PairKind::EdgeEdge ? 2 : 1;
    const auto xA = box(x, 0, second), xB = box(x, second, 4), uA = box(u, 0, second), uB = box(u, second, 4);
    const Vec3 below = (xA[0] - xB[1]) + (uA[0] - uB[1]).cwiseMin(0.0), above = (xB[0] - xA[1]) + (uB[0] - uA[1]).cwiseMin(0.0);
    return std::max(below.maxCoeff(), above.maxCoeff());
}

/// Could the move u bring a pair that is `distance` apart nearer than `bound` [cm]? A quick answer that is never falsely no.
inline bool mayApproach(PairKind kind, const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& u, double distance, double bound)
{
    const double motion = relativeMotion(kind, {toVec3T(u[0]), toVec3T(u[1]), toVec3T(u[2]), toVec3T(u[3])});
    return motion >= distance - bound && sweptGap(kind, x, u) <= bound;
}

}  // namespace sim::contact
