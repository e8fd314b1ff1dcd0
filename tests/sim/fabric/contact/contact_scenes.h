#pragma once

#include "sim/fabric/contact/contact.h"
#include "sim/fabric/contact/primitives.h"
#include "sim/fabric/fabric.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace sim::test {

/// A fabric put together by hand: yarns and cloth of one material, at rest where it starts.
struct ContactScene {
    Fabric fabric;

    ContactScene()
    {
        FabricMaterial m;
        m.young = 6.6e7;
        m.density = 1.32;
        m.volumeFraction = 0.4;
        fabric.materials.push_back(m);
    }

    int addVertex(const Vec3& x, double radius = 0.0, int material = 0)
    {
        fabric.rest.push_back(x);
        fabric.mass.push_back(0.0);
        fabric.volume.push_back(0.0);
        fabric.radius.push_back(radius);
        fabric.vertexMaterial.push_back(material);
        fabric.pinned.push_back(0);
        return static_cast<int>(fabric.rest.size()) - 1;
    }

    void pin(int v) { fabric.pinned[v] = 1; }

    void addStrand(const std::vector<int>& vertices, double radius, int material = 0)
    {
        const int strand = fabric.strands.count();
        fabric.strands.vertices.insert(fabric.strands.vertices.end(), vertices.begin(), vertices.end());
        fabric.strands.begin.push_back(static_cast<int>(fabric.strands.vertices.size()));
        fabric.strands.material.push_back(material);
        fabric.strands.radius.push_back({radius, radius});
        for (std::size_t j = 0; j + 1 < vertices.size(); ++j) {
            const int v = vertices[j], w = vertices[j + 1];
            const double length = (fabric.rest[w] - fabric.rest[v]).norm();
            fabric.edges.vertices.push_back({v, w});
            fabric.edges.strand.push_back(strand);
            fabric.edges.restLength.push_back(length);
            fabric.edges.twistInertia.push_back(0.0);
            fabric.edges.wetTwist.push_back({0.0, 0.0});
            fabric.edges.twistHeld.push_back(0);
            const double half = 0.5 * fabric.materials[material].envelopeDensity() * kPi * radius * radius * length;
            for (int k : {v, w}) {
                fabric.mass[k] += half;
                fabric.radius[k] = std::max(fabric.radius[k], radius);
            }
        }
    }

    /// A straight yarn of n edges.
    void addYarn(const Vec3& from, const Vec3& to, int n, double radius, int material = 0)
    {
        std::vector<int> vertices;
        for (int j = 0; j <= n; ++j) vertices.push_back(addVertex(from + (to - from) * (static_cast<double>(j) / n)));
        addStrand(vertices, radius, material);
    }

    void addFace(const Vec3i& v, double thickness, int material = 0)
    {
        fabric.faces.vertices.push_back(v);
        fabric.faces.material.push_back(material);
        fabric.faces.thickness.push_back(thickness);
        const double area = 0.5 * (fabric.rest[v[1]] - fabric.rest[v[0]]).cross(fabric.rest[v[2]] - fabric.rest[v[0]]).norm();
        for (int k = 0; k < 3; ++k) {
            fabric.mass[v[k]] += fabric.materials[material].envelopeDensity() * thickness * area / 3.0;
            fabric.radius[v[k]] = std::max(fabric.radius[v[k]], 0.5 * thickness);
        }
    }

    /// A flat cloth of n × m squares, corner at `origin`.
    void addCloth(const Vec3& origin, const Vec3& along, const Vec3& across, int n, int m, double thickness, int material = 0)
    {
        const int first = static_cast<int>(fabric.rest.size());
        for (int j = 0; j <= m; ++j)
            for (int i = 0; i <= n; ++i) addVertex(origin + along * i + across * j);
        for (int j = 0; j < m; ++j)
            for (int i = 0; i < n; ++i) {
                const int v = first + j * (n + 1) + i, w = v + n + 1;
                addFace({v, w, v + 1}, thickness, material);
                addFace({v + 1, w, w + 1}, thickness, material);
            }
    }
};

/// The woven sheet of the splash benchmarks with n lines each way: pitch 0.144, a herringbone twill whose yarns of radius 0.048 pass each
/// other at rest nearer than their radii, borders sewn on. n = 100 has 19 604 vertices.
inline Fabric wovenSheet(int n)
{
    constexpr double kPitch = 0.144, kAmplitude = 0.072, kRadius = 0.048;
    ContactScene scene;
    const int inner = n - 2;
    const auto side = [](int j, int k) {  // +1 where x-yarn k is above z-yarn j
        const int shift = static_cast<int>(std::abs(k % 8 - 3.5) - 1.5);
        return (((j + shift) % 4 + 4) % 4 < 2) ? 1.0 : -1.0;
    };
    for (int k = 1; k <= inner; ++k)
        for (int j = 0; j < n; ++j) scene.addVertex({kPitch * j, kAmplitude * side(j, k), kPitch * k});
    for (int m = 1; m <= inner; ++m)
        for (int i = 0; i < n; ++i) scene.addVertex({kPitch * m, -kAmplitude * side(m, i), kPitch * i});
    const double length = kPitch * (n - 1);
    const int corner = 2 * inner * n;
    for (const Vec3& c : {Vec3(0, 0, 0), Vec3(length, 0, 0), Vec3(0, 0, length), Vec3(length, 0, length)}) scene.addVertex(c);

    for (int s = 0; s < 2 * inner; ++s) {
        std::vector<int> yarn(n);
        for (int j = 0; j < n; ++j) yarn[j] = s * n + j;
        scene.addStrand(yarn, kRadius);
    }
    const auto border = [&](int from, int firstYarn, int end, int to) {
        std::vector<int> yarn = {from};
        for (int k = 0; k < inner; ++k) yarn.push_back((firstYarn + k) * n + end);
        yarn.push_back(to);
        scene.addStrand(yarn, kRadius);
    };
    border(corner, 0, 0, corner + 2);
    border(corner, inner, 0, corner + 1);
    border(corner + 1, 0, n - 1, corner + 3);
    border(corner + 2, inner, n - 1, corner + 3);

    for (int c = 0; c < 4; ++c) scene.pin(corner + c);
    for (int s : {0, inner - 1, inner, 2 * inner - 1})
        for (int j : {0, n - 1}) scene.pin(s * n + j);
    return scene.fabric;
}

/// Two of a fabric's primitives, and how near they come.
struct NearPair {
    int a, b;
    contact::PairKind kind;
    std::array<int, 4> vertices;
    contact::ContactDistances range;
};

inline std::array<Vec3T<double>, 4> cornersOf(const std::array<int, 4>& v, std::span<const Vec3> x)
{
    return {toVec3T(x[v[0]]), toVec3T(x[v[1]]), toVec3T(x[v[2]]), toVec3T(x[v[3]])};
}

inline double distanceOf(const NearPair& pair, std::span<const Vec3> x)
{
    const Vec3T<double> s = contact::closestPoints(pair.kind, cornersOf(pair.vertices, x)).separation;
    return std::sqrt(dot(s, s));
}

/// Every pair of a fabric that may ever touch, found by looking at all.
inline std::vector<NearPair> allPairs(const Fabric& fabric)
{
    const contact::Primitives primitives(fabric);
    std::vector<NearPair> pairs;
    const auto add = [&](int a, int b) {
        if (!primitives.canTouch(a, b)) return;
        NearPair pair = {a, b, primitives.kind(a), primitives.vertices(a, b), {}};
        pair.range = primitives.range(a, b, distanceOf(pair, fabric.rest));
        if (pair.range.core > 0.0) pairs.push_back(pair);
    };
    for (int a = 0; a < primitives.edgeCount; ++a)
        for (int b = a + 1; b < primitives.edgeCount; ++b) add(a, b);
    for (int v = primitives.firstVertex(); v < primitives.firstFace(); ++v)
        for (int f = primitives.firstFace(); f < primitives.count(); ++f) add(v, f);
    return pairs;
}

/// Yarns of one edge and single triangles, strewn at random in a cube of 2 cm; radii differ, none too near another.
inline Fabric soup(unsigned seed, int yarns, int triangles)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto vector = [&](double size) { return Vec3(size * unit(random), size * unit(random), size * unit(random)); };
    ContactScene scene;
    for (int i = 0; i < yarns + triangles;) {
        const ContactScene before = scene;
        const Vec3 x = vector(1.0);
        if (i < yarns) scene.addYarn(x, x + vector(0.4), 1, 0.03 + 0.01 * unit(random));
        else {
            const int v = scene.addVertex(x);
            scene.addVertex(x + vector(0.4));
            scene.addVertex(x + vector(0.4));
            scene.addFace({v, v + 1, v + 2}, 0.04 + 0.02 * unit(random));
        }
        const auto joined = [&](const NearPair& p) { return distanceOf(p, scene.fabric.rest) < 0.05; };
        if (std::ranges::any_of(allPairs(scene.fabric), joined)) scene = before;
        else ++i;
    }
    return scene.fabric;
}

/// Random displacements of up to `size` along each axis [cm].
inline std::vector<Vec3> randomMoves(const Fabric& fabric, double size, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-size, size);
    std::vector<Vec3> u(fabric.vertexCount());
    for (Vec3& v : u) v = Vec3(unit(random), unit(random), unit(random));
    return u;
}

/// Contact and the positions it works on.
struct ContactRun {
    static constexpr double kStep = 1.0e-3;

    explicit ContactRun(const Fabric& f) : fabric(f), contact(f), x(f.rest) { contact.beginStep(x, fabric.mass, kStep, kStep); }

    /// Moves as far along u as is safe, and returns how far that was.
    std::vector<Vec3> moveSafely(std::vector<Vec3> u)
    {
        StageClock clock(step);
        const FabricContact::LimitedMoves limited = contact.limit(x, u, report, clock);
        for (std::size_t v = 0; v < x.size(); ++v) x[v] += u[v];
        contact.moved(limited);
        return u;
    }
    const ActiveContacts& active()
    {
        StageClock clock(step);
        return contact.activeAt(x, clock).pairs();
    }

    const Fabric fabric;
    FabricContact contact;
    std::vector<Vec3> x;
    LimitReport report;
    StageTimes step;
};

}  // namespace sim::test
