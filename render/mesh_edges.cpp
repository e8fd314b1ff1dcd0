#include "render/mesh_edges.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace render {

namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

float halfDiagonal(std::span<const Vector3f> positions)
{
    Eigen::AlignedBox3f box;
    for (const Vector3f& x : positions) box.extend(x);
    return box.isEmpty() ? 0.0f : 0.5f * box.diagonal().norm();
}

/// For every position the first of those at the same place, to a hundred-thousandth of the mesh's size.
std::vector<int> weld(std::span<const Vector3f> positions, float size)
{
    const float pitch = size > 0.0f ? 1e-5f * size : 1.0f;
    std::vector<std::array<long, 4>> places;  // lattice place, then index
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vector3f place = positions[i] / pitch;
        places.push_back({std::lround(place.x()), std::lround(place.y()), std::lround(place.z()), static_cast<long>(i)});
    }
    std::ranges::sort(places);
    std::vector<int> first(positions.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const bool isCopy = k > 0 && std::equal(places[k].begin(), places[k].begin() + 3, places[k - 1].begin());
        first[places[k][3]] = isCopy ? first[places[k - 1][3]] : static_cast<int>(places[k][3]);
    }
    return first;
}

struct Faces {
    std::vector<Vector3i> corners;  ///< welded
    std::vector<Vector3f> normals;  ///< unit, zero for triangles without area
    std::vector<float> areas;
};

Faces facesOf(const FrameView::Mesh& mesh, float size)
{
    const std::vector<int> first = weld(mesh.positions, size);
    Faces faces;
    for (const Vector3i& t : mesh.triangles) {
        if (t.minCoeff() < 0 || t.maxCoeff() >= static_cast<int>(mesh.positions.size()))
            throw std::invalid_argument("obstacle: a triangle names a position that is not there");
        const Vector3i corners(first[t[0]], first[t[1]], first[t[2]]);
        const Vector3f& a = mesh.positions[corners[0]];
        const Vector3f normal = (mesh.positions[corners[1]] - a).cross(mesh.positions[corners[2]] - a);
        faces.corners.push_back(corners);
        faces.normals.push_back(normal.normalized());
        faces.areas.push_back(0.5f * normal.norm());
    }
    return faces;
}

/// One side of one triangle, its ends in order.
struct HalfEdge {
    int low, high, face;
    auto operator<=>(const HalfEdge&) const = default;
};

std::vector<HalfEdge> sortedHalfEdges(const Faces& faces)
{
    std::vector<HalfEdge> halves;
    for (std::size_t f = 0; f < faces.corners.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            if (!(faces.areas[f] > 0.0f)) continue;
            const int a = faces.corners[f][k], b = faces.corners[f][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f)});
        }
    std::ranges::sort(halves);
    return halves;
}

float angleBetween(const Vector3f& a, const Vector3f& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Area-weighted mean of the normals around each corner, over the faces that meet this one below the crease angle.
void smoothNormals(const Faces& faces, std::size_t positions, float cosCrease, MeshEdges& result)
{
    std::vector<std::vector<int>> around(positions);
    for (std::size_t f = 0; f < faces.corners.size(); ++f)
        for (const int corner : faces.corners[f]) around[corner].push_back(static_cast<int>(f));
    result.cornerNormals.resize(faces.corners.size());
    for (std::size_t f = 0; f < faces.corners.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            Vector3f sum = Vector3f::Zero();
            for (const int other : around[faces.corners[f][k]])
                if (faces.normals[other].dot(faces.normals[f]) >= cosCrease) sum += faces.areas[other] * faces.normals[other];
            result.cornerNormals[f][k] = sum.normalized();
        }
}

}  // namespace

MeshEdges meshEdges(const FrameView::Mesh& mesh, float creaseDegrees)
{
    constexpr float kFlat = 1e-3f;  // [rad]: faces this close to one plane share no line
    const float crease = creaseDegrees * std::numbers::pi_v<float> / 180.0f;
    constexpr float kSliver = 1e-6f;  // triangles smaller than this share of size² say nothing of curvature
    const float size = halfDiagonal(mesh.positions);
    const Faces faces = facesOf(mesh, size);
    const std::vector<HalfEdge> halves = sortedHalfEdges(faces);

    MeshEdges result;
    result.bend.assign(faces.corners.size(), 0.0f);
    smoothNormals(faces, mesh.positions.size(), std::cos(crease), result);

    for (std::size_t h = 0; h < halves.size();) {
        const HalfEdge& half = halves[h];
        std::size_t end = h + 1;
        while (end < halves.size() && halves[end].low == half.low && halves[end].high == half.high) ++end;
        const int other = halves[end - 1].face;
        const Vector3f &a = mesh.positions[half.low], &b = mesh.positions[half.high];
        const float angle = angleBetween(faces.normals[half.face], faces.normals[other]);
        const bool isSharp = end - h != 2 || angle > crease;
        if (isSharp || angle > kFlat) {
            result.edges.push_back({a, b, faces.normals[half.face], faces.normals[other], isSharp});
            // The bend along an edge, angle · length, belongs by halves to the faces that meet there.
            for (const int f : {half.face, other})
                if (!isSharp && faces.areas[f] > kSliver * size * size) result.bend[f] += 0.5f * angle * (b - a).norm() / faces.areas[f] * size;
        }
        h = end;
    }
    return result;
}

}  // namespace render
