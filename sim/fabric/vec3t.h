#pragma once

#include "sim/core/simd.h"
#include "sim/core/types.h"

#include <cmath>

// 3-vectors whose components are numbers or packs, so that a kernel is written once and runs for one element or for kLanes at once.

namespace sim {

template <class T>
struct Vec3T {
    T x, y, z;

    T& operator[](int a) { return a == 0 ? x : a == 1 ? y : z; }
    const T& operator[](int a) const { return a == 0 ? x : a == 1 ? y : z; }
    Vec3T& operator+=(const Vec3T& b) { return *this = *this + b; }
    Vec3T& operator-=(const Vec3T& b) { return *this = *this - b; }

    friend Vec3T operator+(const Vec3T& a, const Vec3T& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3T operator-(const Vec3T& a, const Vec3T& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3T operator-(const Vec3T& a) { return {-a.x, -a.y, -a.z}; }
    friend Vec3T operator*(const T& s, const Vec3T& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend T dot(const Vec3T& a, const Vec3T& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Vec3T cross(const Vec3T& a, const Vec3T& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
};

using PackVec3 = Vec3T<Pack>;

inline double squareRoot(double v) { return std::sqrt(v); }
inline Pack squareRoot(Pack v) { return sqrtPack(v); }
inline double largerOf(double a, double b) { return b > a ? b : a; }
inline Pack largerOf(Pack a, Pack b) { return maxPack(a, b); }

/// 1, or −1 where v is negative.
inline double signOf(double v) { return v < 0.0 ? -1.0 : 1.0; }
inline Pack signOf(Pack v) { return select(v < 0.0, broadcast(-1.0), broadcast(1.0)); }

template <class T>
T constant(double v)
{
    if constexpr (std::is_same_v<T, Pack>) return broadcast(v);
    else return v;
}

template <class T>
T norm(const Vec3T<T>& a)
{
    return squareRoot(dot(a, a));
}

inline Vec3T<double> toVec3T(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 toVec3(const Vec3T<double>& v) { return {v.x, v.y, v.z}; }

inline void setLane(PackVec3& a, int lane, const Vec3& v)
{
    a.x[lane] = v.x();
    a.y[lane] = v.y();
    a.z[lane] = v.z();
}
inline Vec3 laneOf(const PackVec3& a, int lane) { return {a.x[lane], a.y[lane], a.z[lane]}; }

}  // namespace sim
