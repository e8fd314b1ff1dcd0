#pragma once

#include <Eigen/Core>

#include <span>

namespace render {

/// What one picture needs, borrowed for the length of one draw call. World space, lengths in cm.
/// The renderer knows nothing else of the simulation; app/frame_view_from_state.cpp fills it in.
struct FrameView {
    struct Liquid {
        std::span<const Eigen::Vector3f> positions;
        std::span<const float> values;             ///< one per position: what colours it, say the speed [cm/s]
        float radius = 0.0f;                       ///< of every sphere [cm]
    };
    struct Mesh {
        std::span<const Eigen::Vector3f> positions;
        std::span<const Eigen::Vector3i> triangles;
        bool inside = false;                       ///< a container, seen from within
    };

    double time = 0.0;                             ///< [s]
    Liquid liquid;
    std::span<const Mesh> obstacles;
};

}  // namespace render
