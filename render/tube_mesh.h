#pragma once

#include "render/frame_view.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace render {

/// The surface of yarns as triangles that face outwards.
struct TubeMesh {
    struct Vertex {
        Eigen::Vector3f position, normal;   ///< [cm], [-]
        float turn;                         ///< length of the yarn at rest up to here / pitch of its plies [-]
        float angle;                        ///< angle about the yarn, from m1 [turns]: 0 … 1
        float value;                        ///< value of FrameView, or 0
        std::array<std::uint8_t, 4> color;  ///< alpha: 255 = this colour, 0 = that of the value
    };
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;

    void clear() { vertices.clear(), indices.clear(); }
};

/// How finely a tube is made: as finely as it can be seen.
struct TubeDetail {
    Eigen::Vector3f eye = Eigen::Vector3f::Zero();  ///< [cm]
    float pixelsPerTangent = 1.0f;                  ///< pixels of 1 cm at 1 cm from the eye
    int sides = 10;                                 ///< number of sides of a tube that is large in the picture, at least 3
};

/// The strand is so thin in the picture that its plies cannot be seen.
bool isThin(const FrameView::Yarns& yarns, int strand, const TubeDetail& detail);

/// The color of a Vertex by its wetness, 0 = dry … 1 = soaked.
using TubeColor = std::function<std::array<std::uint8_t, 4>(float)>;

/// Adds one strand: a tube of elliptic section with round ends, through the vertices and round between them. Vertices
/// that are not finite end the tube; a strand of one vertex or without extent has none.
/// @param strand  in view.begin
void addTube(const FrameView::Yarns& yarns, int strand, const TubeDetail& detail, const TubeColor& color, TubeMesh& mesh);

}  // namespace render
