#pragma once

#include "render/frame_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

// Fabric made up from formulas. Same numbers on every machine.

/// A ball of `rings` rings of triangles.
inline void addBall(const Eigen::Vector3f& center, float radius, int rings, std::vector<Eigen::Vector3f>& positions,
                    std::vector<Eigen::Vector3i>& triangles)
{
    const int sectors = 2 * rings;
    const float pi = std::numbers::pi_v<float>;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sectors; ++j) {
            const float polar = pi * static_cast<float>(i) / static_cast<float>(rings);
            const float turn = 2.0f * pi * static_cast<float>(j % sectors) / static_cast<float>(sectors);
            positions.push_back(center +
                                radius * Eigen::Vector3f(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn)));
        }
    for (int i = 0; i < rings; ++i)
        for (int j = 0; j < sectors; ++j) {
            const int a = i * (sectors + 1) + j, b = a + sectors + 1;
            triangles.insert(triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
        }
}

/// Yarns, to which strands are added one by one.
struct FakeYarns {
    std::vector<Eigen::Vector3f> positions, directions;
    std::vector<float> along, values;
    std::vector<int> begin = {0}, materials;
    std::vector<std::array<float, 2>> halfAxes;

    void add(const Eigen::Vector3f& x, const Eigen::Vector3f& m1, float value = 0.0f)
    {
        const bool isFirst = static_cast<int>(positions.size()) == begin.back();
        along.push_back(isFirst ? 0.0f : along.back() + (x - positions.back()).norm());
        positions.push_back(x), directions.push_back(m1), values.push_back(value);
    }
    void endStrand(float a, float b, int material = 0)
    {
        begin.push_back(static_cast<int>(positions.size()));
        halfAxes.push_back({a, b}), materials.push_back(material);
    }
    render::FrameView::Yarns view() const { return {positions, directions, along, begin, halfAxes, materials, values}; }
};

/// A plain weave of `count` x `count` yarns that a ball has sunk into; a vertex at each crossing.
struct FakeSheet {
    FakeYarns yarns;
    std::vector<Eigen::Vector3f> ballPositions;
    std::vector<Eigen::Vector3i> ballTriangles;
    std::vector<render::FrameView::Mesh> meshes;

    explicit FakeSheet(int count, float spacing = 0.144f, float radius = 0.048f)
    {
        const float half = 0.5f * spacing * static_cast<float>(count - 1), ball = 0.2f * half, contact = 1.1f;
        const float decay = 0.45f * half, depth = 0.55f * decay;
        const auto height = [&](float x, float z) {
            const float r = std::hypot(x, z), rim = ball * std::sin(contact);
            if (r < rim) return -depth + ball * std::cos(contact) - std::sqrt(ball * ball - r * r);
            const float edge = std::max(0.0f, 1.0f - std::pow(std::max(std::abs(x), std::abs(z)) / half, 4.0f));
            return -depth * std::exp(-(r - rim) / decay * (1.0f + 1.2f * std::exp(-(r - rim) / (0.3f * decay)))) * edge;
        };
        for (int direction = 0; direction < 2; ++direction)
            for (int i = 0; i < count; ++i) {
                for (int j = 0; j < count; ++j) {
                    const float s = spacing * static_cast<float>(i) - half, t = spacing * static_cast<float>(j) - half;
                    const float x = direction == 0 ? t : s, z = direction == 0 ? s : t;
                    const float over = (i + j + direction) % 2 == 0 ? radius : -radius;
                    const float y = height(x, z);
                    yarns.add({x, y + over, z}, Eigen::Vector3f::UnitY(), 100.0f * std::abs(y) / depth);
                }
                yarns.endStrand(radius, radius, direction);
            }
        addBall({0.0f, -depth + ball * std::cos(contact) + 2.0f * radius, 0.0f}, ball, 48, ballPositions, ballTriangles);
        meshes.push_back({ballPositions, ballTriangles, false});
    }
    render::FrameView view() const { return {.time = 0.25, .liquid = {}, .obstacles = meshes, .yarns = yarns.view(), .cloth = {}}; }
};

/// A square cloth of `count` x `count` vertices that hangs over a ball in folds.
struct FakeDrape {
    std::vector<Eigen::Vector3f> positions, ballPositions;
    std::vector<Eigen::Vector3i> triangles, ballTriangles;
    std::vector<float> thickness, values;
    std::vector<int> materials;
    std::vector<render::FrameView::Mesh> meshes;

    explicit FakeDrape(int count, float side = 12.0f, float clothThickness = 0.06f)
    {
        const float ball = 2.2f, leave = 1.2f;  // the cloth leaves the ball at this polar angle [rad]
        for (int j = 0; j < count; ++j)
            for (int i = 0; i < count; ++i) {
                const float u = side * (static_cast<float>(i) / static_cast<float>(count - 1) - 0.5f);
                const float v = side * (static_cast<float>(j) / static_cast<float>(count - 1) - 0.5f);
                positions.push_back(draped(u, v, ball + 0.5f * clothThickness, leave));
                thickness.push_back(clothThickness);
                materials.push_back(1);
                values.push_back(0.1f * std::exp(-std::pow(std::hypot(u, v) / ball - leave, 2.0f)));
            }
        for (int j = 0; j + 1 < count; ++j)
            for (int i = 0; i + 1 < count; ++i) {
                const int a = j * count + i, b = a + 1, c = a + count, d = c + 1;
                triangles.insert(triangles.end(), {{a, d, b}, {a, c, d}});
            }
        addBall(Eigen::Vector3f::Zero(), ball, 40, ballPositions, ballTriangles);
        meshes.push_back({ballPositions, ballTriangles, false});
    }
    static Eigen::Vector3f draped(float u, float v, float ball, float leave)
    {
        const float s = std::hypot(u, v), turn = std::atan2(v, u), polar = std::min(s / ball, leave);
        const float hanging = std::max(0.0f, s - leave * ball);
        const float fold =
            0.24f * hanging * hanging / (0.8f + hanging + 0.15f * hanging * hanging) * (std::cos(8.0f * turn) + 0.3f * std::sin(5.0f * turn + 1.0f));
        const float out = ball * std::sin(polar) + 0.25f * hanging * std::exp(-0.1f * hanging) + 0.45f * (1.0f - std::exp(-1.5f * hanging)) + fold;
        return {out * std::cos(turn), ball * std::cos(polar) - 0.93f * hanging, out * std::sin(turn)};
    }
    render::FrameView::Cloth cloth() const { return {positions, triangles, thickness, materials, values}; }
    render::FrameView view() const { return {.time = 0.5, .liquid = {}, .obstacles = meshes, .yarns = {}, .cloth = cloth()}; }
};
