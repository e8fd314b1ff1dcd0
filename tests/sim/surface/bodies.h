#pragma once

#include "sim/core/units.h"
#include "sim/surface/liquid_surface.h"

#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace sim::test {

inline constexpr double kPitch = 0.1, kDensity = 1.2;  ///< [cm], [g/cm^3]

inline void addAt(LiquidParticles& liquid, const Vec3& x, double volume = kPitch * kPitch * kPitch)
{
    liquid.add(x, kDensity * volume, static_cast<std::uint32_t>(liquid.count), Vec3::Zero());
}

/// A cubic lattice of particles where `contains` says so, each moved by up to `jitter` pitches along each axis.
template <class Contains>
LiquidParticles latticeBody(const Vec3& low, const Vec3& high, double jitter, Contains&& contains)
{
    LiquidParticles liquid;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const Vec3i size = ((high - low) / kPitch).array().round().cast<int>();
    for (int k = 0; k < size.z(); ++k)
        for (int j = 0; j < size.y(); ++j)
            for (int i = 0; i < size.x(); ++i) {
                const Vec3 x = low + kPitch * (Vec3(i, j, k) + Vec3::Constant(0.5));
                if (contains(x)) addAt(liquid, x + jitter * kPitch * Vec3(unit(random), unit(random), unit(random)));
            }
    return liquid;
}

inline LiquidParticles ball(double radius, double jitter = 0.0, const Vec3& center = Vec3::Zero())
{
    const Vec3 half = Vec3::Constant(kPitch * (std::ceil(radius / kPitch) + 0.5));
    return latticeBody(center - half, center + half, jitter, [&](const Vec3& x) { return (x - center).norm() < radius; });
}

inline LiquidParticles box(const Vec3& size, double jitter = 0.0)
{
    return latticeBody(-0.5 * size, 0.5 * size, jitter, [](const Vec3&) { return true; });
}

/// What makes a mesh a closed, oriented manifold: each edge is passed once in each direction.
inline bool isClosed(const SurfaceMesh& mesh)
{
    std::map<std::pair<int, int>, int> passed;
    for (const Vec3i& t : mesh.triangles)
        for (int c = 0; c < 3; ++c) ++passed[{t[c], t[(c + 1) % 3]}];
    for (const auto& [edge, times] : passed) {
        const auto back = passed.find({edge.second, edge.first});
        if (edge.first == edge.second || times != 1 || back == passed.end() || back->second != 1) return false;
    }
    return true;
}

/// Vertices − edges + triangles of a closed mesh: twice the number of its bodies less twice that of their handles.
inline int eulerCharacteristic(const SurfaceMesh& mesh)
{
    return static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

/// Liquid of a shape.
struct Body {
    const char* name;
    LiquidParticles liquid;
};

inline std::vector<Body> bodies()
{
    return {{"ball", ball(1.0)},
            {"shaken ball", ball(1.0, 0.5)},
            {"box", box({0.7, 1.1, 1.6})},
            {"shaken box", box({0.7, 1.1, 1.6}, 0.5)},
            {"sheet of one layer", box({1.5, kPitch, 1.7})},
            {"sheet of two layers", box({1.5, 2.0 * kPitch, 1.7})},
            {"shaken sheet of three layers", box({1.5, 3.0 * kPitch, 1.7}, 0.4)}};
}

/// v0 + gradient x.
inline void setVelocities(LiquidParticles& liquid, const Vec3& v0, const Mat3& gradient)
{
    for (std::size_t p = 0; p < liquid.count; ++p) {
        const Vec3 v = v0 + gradient * liquid.position(p);
        for (int a = 0; a < kAxes; ++a) liquid.mode(a, 0)[p] = v[a];
    }
}

}  // namespace sim::test
