#pragma once

#include "render/frame_view.h"

#include <cstdint>
#include <vector>

namespace render {

/// Cloth as a closed body: both sides, half its thickness away from its middle, and a rim along the border. Triangles
/// face outwards.
struct ClothMesh {
    struct Vertex {
        Eigen::Vector3f position, normal;  ///< [cm], [-]
        std::uint32_t source;              ///< the position in the view that it comes from
        bool isBack;                       ///< whether it is on the side from which triangles are seen clockwise
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
};

/// Normals are smooth: means of the faces' weighted by their angle at the vertex. Triangles with a corner that is not
/// finite are left out. Throws std::invalid_argument if a triangle names a position that is not there.
void makeClothMesh(const FrameView::Cloth& cloth, ClothMesh& mesh);

}  // namespace render
