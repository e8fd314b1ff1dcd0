#pragma once

#include "render/frame_view.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace app {

/// One frame as it was when the simulation passed it: what a picture needs, copied out of the state in single precision,
/// so that drawing it does not hold up the simulation.
struct FrameSnapshot {
    struct Mesh {
        std::vector<Eigen::Vector3f> positions;   ///< [cm]
        std::vector<Eigen::Vector3i> triangles;
        bool inside = false;                      ///< a container, seen from within
    };

    struct Yarns {
        std::vector<Eigen::Vector3f> positions, directions;  ///< [cm], [-]
        std::vector<float> along, values, wetness;  ///< [cm]; values empty where the colour is that of the material, wetness [0..1] where all is dry
        std::vector<int> begin, materials;
        std::vector<std::array<float, 2>> halfAxes;   ///< [cm]
    };
    struct Cloth {
        std::vector<Eigen::Vector3f> positions;   ///< of all vertices of the fabric; empty without faces [cm]
        std::vector<Eigen::Vector3i> triangles;
        std::vector<float> thickness, values, wetness;  ///< [cm]; as those of yarns
        std::vector<int> materials;
    };

    std::int64_t number = 0;                      ///< 0 is the initial state
    double time = 0.0;                            ///< [s]
    std::vector<Eigen::Vector3f> positions;       ///< of the particles [cm]
    std::vector<float> speeds;                    ///< one per position [cm/s]
    float radius = 0.0f;                          ///< of a particle [cm]
    Yarns yarns;
    Cloth cloth;
    std::vector<Mesh> obstacles;
    std::vector<render::FrameView::Mesh> borrowedObstacles;  ///< the same, as view() lends them

    /// Valid until the snapshot changes.
    render::FrameView view();
};

}  // namespace app
