#include "render/cloth_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace render {

namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr std::uint32_t kUnused = ~0u;

std::vector<Vector3i> soundTriangles(const FrameView::Cloth& cloth)
{
    std::vector<Vector3i> triangles;
    triangles.reserve(cloth.triangles.size());
    for (const Vector3i& t : cloth.triangles) {
        if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(cloth.positions.size()))
            throw std::invalid_argument("picture: a triangle of the cloth names a position that is not there");
        if (cloth.positions[t[0]].allFinite() && cloth.positions[t[1]].allFinite() && cloth.positions[t[2]].allFinite()) triangles.push_back(t);
    }
    return triangles;
}

std::vector<Vector3f> smoothNormals(std::span<const Vector3f> x, const std::vector<Vector3i>& triangles)
{
    std::vector<Vector3f> normals(x.size(), Vector3f::Zero());
    for (const Vector3i& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const Vector3f e = x[t[(k + 1) % 3]] - x[t[k]], f = x[t[(k + 2) % 3]] - x[t[k]], n = e.cross(f);
            const float twiceArea = n.norm();
            if (twiceArea > 0.0f) normals[t[k]] += std::atan2(twiceArea, e.dot(f)) / twiceArea * n;
        }
    for (Vector3f& n : normals) {
        const float length = n.norm();
        n = length > 0.0f ? Vector3f(n / length) : Vector3f(Vector3f::UnitZ());
    }
    return normals;
}

/// Edges with a triangle on one side only, in the direction in which it goes round.
std::vector<std::array<int, 2>> borderEdges(const std::vector<Vector3i>& triangles)
{
    struct HalfEdge {
        int low, high;
        bool isReversed;
    };
    std::vector<HalfEdge> halves;
    halves.reserve(3 * triangles.size());
    for (const Vector3i& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), a > b});
        }
    const auto ends = [](const HalfEdge& h) { return std::pair(h.low, h.high); };
    std::ranges::sort(halves, {}, ends);
    std::vector<std::array<int, 2>> border;
    for (std::size_t i = 0, next; i < halves.size(); i = next) {
        for (next = i + 1; next < halves.size() && ends(halves[next]) == ends(halves[i]);) ++next;
        if (next == i + 1) {
            const HalfEdge& h = halves[i];
            border.push_back(h.isReversed ? std::array{h.high, h.low} : std::array{h.low, h.high});
        }
    }
    return border;
}

void addRim(const FrameView::Cloth& cloth, const std::vector<Vector3f>& normals, const std::array<int, 2>& edge, ClothMesh& mesh)
{
    const Vector3f along = cloth.positions[edge[1]] - cloth.positions[edge[0]];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const int v : edge) {
        const Vector3f outwards = along.cross(normals[v]).normalized(), half = 0.5f * cloth.thickness[v] * normals[v];
        for (const float side : {1.0f, -1.0f})
            mesh.vertices.push_back({cloth.positions[v] + side * half, outwards, static_cast<std::uint32_t>(v), false});
    }
    // Front of the first end, its back, then those of the second.
    for (const std::uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u}) mesh.indices.push_back(first + k);
}

}  // namespace

void makeClothMesh(const FrameView::Cloth& cloth, ClothMesh& mesh)
{
    mesh.vertices.clear();
    mesh.indices.clear();
    const std::vector<Vector3i> triangles = soundTriangles(cloth);
    const std::vector<Vector3f> normals = smoothNormals(cloth.positions, triangles);

    // Front and back of a position stand side by side, numbered when a triangle first names it.
    std::vector<std::uint32_t> front(cloth.positions.size(), kUnused);
    for (const Vector3i& t : triangles)
        for (const int v : t) {
            if (front[v] != kUnused) continue;
            front[v] = static_cast<std::uint32_t>(mesh.vertices.size());
            const Vector3f half = 0.5f * cloth.thickness[v] * normals[v];
            mesh.vertices.push_back({cloth.positions[v] + half, normals[v], static_cast<std::uint32_t>(v), false});
            mesh.vertices.push_back({cloth.positions[v] - half, -normals[v], static_cast<std::uint32_t>(v), true});
        }
    for (const Vector3i& t : triangles) {
        const std::uint32_t a = front[t[0]], b = front[t[1]], c = front[t[2]];
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a + 1, c + 1, b + 1});
    }
    for (const auto& edge : borderEdges(triangles)) addRim(cloth, normals, edge, mesh);
}

}  // namespace render
