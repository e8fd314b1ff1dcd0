#pragma once

#include "render/frame_view.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace render {

/// What the outline of a triangle mesh is made of. Corners at the same place count as one, however they are indexed.
struct MeshEdges {
    struct Edge {
        Eigen::Vector3f a, b;              ///< ends [cm]
        Eigen::Vector3f normal0, normal1;  ///< normals of the faces left and right; equal at an open border
        bool isSharp = false;              ///< a crease or a border; others show as silhouettes only
    };
    std::vector<Edge> edges;                                    ///< edges, without those inside of flat faces
    std::vector<std::array<Eigen::Vector3f, 3>> cornerNormals;  ///< per triangle: smooth, but for creases
    std::vector<float> bend;                                    ///< per triangle: its curvature · the mesh's half diagonal [-]
};

/// @param creaseDegrees  faces that meet at more than this make a sharp edge
/// Triangles without area are left out of edges; their normals are zero.
/// Throws std::invalid_argument if a triangle names a position that is not there.
MeshEdges meshEdges(const FrameView::Mesh& mesh, float creaseDegrees = 40.0f);

}  // namespace render
