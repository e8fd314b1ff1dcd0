#pragma once

#include "tests/render/fake_fabric.h"

/// Balls as the surface of a liquid.
struct FakeLiquidSurface {
    void addBall(const Eigen::Vector3f& center, float radius, int rings)
    {
        const auto first = static_cast<int>(positions.size());
        const std::size_t before = triangles.size();
        ::addBall(center, radius, rings, positions, triangles);
        for (std::size_t t = before; t < triangles.size(); ++t) triangles[t].array() += first;
        for (std::size_t v = normals.size(); v < positions.size(); ++v) normals.push_back((positions[v] - center).normalized());
    }
    render::FrameView::LiquidSurface view() const { return {positions, normals, values, triangles}; }

    std::vector<Eigen::Vector3f> positions, normals;
    std::vector<float> values;
    std::vector<Eigen::Vector3i> triangles;
};
