#pragma once

#include <Eigen/Core>

#include <array>
#include <span>

namespace render {

/// What one picture needs, borrowed for the length of one draw call. World space, lengths in cm.
/// The renderer knows nothing else of the simulation; app/frames/snapshot_from_state.cpp fills it in.
struct FrameView {
    struct Liquid {
        std::span<const Eigen::Vector3f> positions;
        std::span<const float> values;  ///< one per position: what colours it, say the speed [cm/s]
        float radius = 0.0f;            ///< radius of every sphere [cm]
    };
    /// The surface of the liquid, for looks that show it instead of particles.
    struct LiquidSurface {
        std::span<const Eigen::Vector3f> positions;
        std::span<const Eigen::Vector3f> normals;  ///< one per position, outwards, of length 1
        std::span<const float> values;             ///< one per position what colours it; not needed by a flat look
        std::span<const Eigen::Vector3i> triangles;
    };
    /// Strands of all yarns, their vertices one behind the other.
    struct Yarns {
        std::span<const Eigen::Vector3f> positions;
        std::span<const Eigen::Vector3f> directions;     ///< per position: first axis m1 of the section, across the yarn
        std::span<const float> along;                    ///< per position: length of the yarn at rest up to here [cm]
        std::span<const int> begin;                      ///< begin of each strand in `positions`, and the end of the last
        std::span<const std::array<float, 2>> halfAxes;  ///< half axes of each strand's section, along m1 and across it [cm]
        std::span<const int> materials;                  ///< per strand: which colour of the look
        std::span<const float> values;                   ///< per position what colours it; needed by a look that says so
        std::span<const float> wetness = {};             ///< per position: 0 = dry … 1 = soaked; empty where all is dry
    };
    struct Cloth {
        std::span<const Eigen::Vector3f> positions;  ///< positions of the vertices; those that no triangle names are not drawn
        std::span<const Eigen::Vector3i> triangles;
        std::span<const float> thickness;     ///< per position, of the whole cloth [cm]
        std::span<const int> materials;       ///< per position: which colour of the look
        std::span<const float> values;        ///< per position what colours it; needed by a look that says so
        std::span<const float> wetness = {};  ///< per position: 0 = dry … 1 = soaked; empty where all is dry
    };
    struct Mesh {
        std::span<const Eigen::Vector3f> positions;
        std::span<const Eigen::Vector3i> triangles;
        bool inside = false;  ///< a container, seen from within
    };
    /// Segments that are drawn alike: annotations over the scene, which the camera does not frame.
    struct Lines {
        std::span<const Eigen::Vector3f> points;  ///< two per segment
        Eigen::Vector3f color = Eigen::Vector3f::Zero();
        float width = 1.5f;      ///< width in a picture 720 pixels high [pixels], 1 at least in any
        bool isTapered = false;  ///< whether a segment is so wide at its first point and ends in a point at its second
        float rim = 0.0f;        ///< width of white below its edges, so that it stands out, in a picture 720 pixels high [pixels]
        float lift = 0.0f;       ///< as if this much nearer to the eye: what is thinner does not hide them [cm]
    };

    double time = 0.0;  ///< [s]
    Liquid liquid;
    std::span<const Mesh> obstacles;
    Yarns yarns = {};
    Cloth cloth = {};
    std::span<const Lines> lines = {};
    LiquidSurface surface = {};
};

}  // namespace render
