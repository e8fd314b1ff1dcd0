#pragma once

#include "render/frame_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

/// Something that looks like a dam break, made up from formulas: a column of liquid that has run down a tank to the
/// left and splashes up its wall. Same numbers on every machine.
struct FakeDamBreak {
    std::vector<Eigen::Vector3f> positions;
    std::vector<float> speeds;  ///< [cm/s]
    std::vector<Eigen::Vector3f> tankPositions;
    std::vector<Eigen::Vector3i> tankTriangles;
    std::vector<render::FrameView::Mesh> meshes;
    float radius = 0.0f;  ///< [cm]

    /// @param spacing  between particles [cm]
    explicit FakeDamBreak(float spacing);
    render::FrameView view() const { return {0.124, {positions, speeds, radius}, meshes}; }
};

/// A repeatable number in −1 … 1 for a seed.
inline float noise(std::uint32_t seed)
{
    seed = (seed ^ 61u) ^ (seed >> 16);
    seed *= 9u;
    seed ^= seed >> 4;
    seed *= 0x27d4eb2du;
    seed ^= seed >> 15;
    return static_cast<float>(seed % 20001u) / 10000.0f - 1.0f;
}

/// A box with edges rounded by `round`: the corners of a subdivided cube pushed onto it.
inline void addRoundedBox(const Eigen::Vector3f& low, const Eigen::Vector3f& high, float round, int arcSteps, std::vector<Eigen::Vector3f>& positions,
                          std::vector<Eigen::Vector3i>& triangles)
{
    // Along each axis of a face: an arc, one flat piece, an arc.
    std::vector<float> angle;
    const float quarter = 0.785398163f;
    for (int i = 0; i <= arcSteps; ++i) angle.push_back(-quarter + quarter * static_cast<float>(i) / static_cast<float>(arcSteps));
    const int n = static_cast<int>(2 * angle.size());
    const auto tangent = [&](int i) { return i < n / 2 ? std::tan(angle[i]) : -std::tan(angle[n - 1 - i]); };
    const Eigen::Vector3f center = 0.5f * (low + high), half = 0.5f * (high - low) - Eigen::Vector3f::Constant(round);
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            const int first = static_cast<int>(positions.size()), u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    Eigen::Vector3f direction, core;
                    direction[axis] = side, direction[u] = tangent(i), direction[v] = tangent(j);
                    core[axis] = side * half[axis];
                    core[u] = (i < n / 2 ? -1.0f : 1.0f) * half[u];
                    core[v] = (j < n / 2 ? -1.0f : 1.0f) * half[v];
                    positions.push_back(center + core + round * direction.normalized());
                }
            for (int j = 0; j + 1 < n; ++j)
                for (int i = 0; i + 1 < n; ++i) {
                    const int a = first + j * n + i, b = a + 1, c = a + n, d = c + 1;
                    if (side > 0.0f) triangles.insert(triangles.end(), {{a, b, d}, {a, d, c}});
                    else triangles.insert(triangles.end(), {{a, d, b}, {a, c, d}});
                }
        }
}

inline FakeDamBreak::FakeDamBreak(float spacing) : radius(0.6f * spacing)
{
    const Eigen::Vector3f low = {-22.32f, -0.72f, -0.72f}, high = {7.92f, 29.52f, 2.16f};
    addRoundedBox(low, high, 0.72f, 5, tankPositions, tankTriangles);
    meshes.push_back({tankPositions, tankTriangles, true});

    const auto surface = [](float x, float z) {  // height of the liquid over the floor
        const float remaining = 9.5f / (1.0f + std::exp(-(x + 1.0f) / 2.2f));
        const float tongue = 1.9f + 0.25f * std::sin(1.1f * x) + 0.15f * std::sin(3.1f * z + 0.7f * x);
        const float wall = 13.0f * std::exp(-(x + 22.32f) / 0.9f);
        return remaining + tongue + wall;
    };
    std::uint32_t seed = 1;
    for (float x = low.x() + 0.5f * spacing; x < high.x(); x += spacing)
        for (float y = low.y() + 0.5f * spacing; y < high.y(); y += spacing)
            for (float z = low.z() + 0.5f * spacing; z < high.z(); z += spacing, seed += 5) {
                const float depth = surface(x, z) - (y - low.y());
                const bool isDrop = depth < 0.0f && depth > -5.0f && x < -14.0f && noise(seed + 4) > 0.985f;
                if (depth < 0.0f && !isDrop) continue;
                const Eigen::Vector3f jitter = {noise(seed), noise(seed + 1), noise(seed + 2)};
                positions.push_back(Eigen::Vector3f(x, y, z) + 0.3f * spacing * jitter);
                const float run = 175.0f * std::exp(-std::pow((x + 15.0f) / 8.5f, 2.0f));
                const float climb = 95.0f * std::exp(-(x + 22.32f) / 1.2f) * (1.0f - (y - low.y()) / 20.0f);
                const float sink = 45.0f * std::max(0.0f, (y - low.y()) / 12.0f) * (x > -8.0f ? 1.0f : 0.3f);
                speeds.push_back(std::clamp(run * std::exp(-0.03f * depth) + climb + sink + 6.0f * noise(seed + 3), 0.0f, 210.0f));
            }
}
