#pragma once

#include "app/scene/picture_settings.h"
#include "render/frame_view.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace app {

/// What a snapshot shows of liquid and fabric beside where they are. Nothing that is not wanted costs anything.
struct SnapshotExtras {
    bool pressure = false;  ///< the liquid's values are pressures [dyn/cm^2], not speeds [cm/s]
    FabricColorBy yarns = FabricColorBy::Material, cloth = FabricColorBy::Material;  ///< what their values are
    bool surface = false;                                                            ///< the surface of the liquid as well, for looks that show it
    bool blocks = false;                                                             ///< edges of the grid's blocks
    bool arrows = false;                                                             ///< where some of the particles go
    bool contacts = false;                                                           ///< lines between fabric and the fabric it touches
    double arrowTime = 0.01;                                                         ///< time that an arrow tells ahead [s]

    bool operator==(const SnapshotExtras&) const = default;
};

/// One frame as it was when the simulation passed it: what a picture needs, copied out of the state in single precision,
/// so that drawing it does not hold up the simulation.
struct FrameSnapshot {
    struct Mesh {
        std::vector<Eigen::Vector3f> positions;   ///< [cm]
        std::vector<Eigen::Vector3f> velocities;  ///< one per position; empty: it never moves [cm/s]
        std::vector<Eigen::Vector3i> triangles;
        bool inside = false;  ///< a container, seen from within
        std::string name;     ///< as in the scene
    };

    struct Surface {
        std::vector<Eigen::Vector3f> positions, normals;  ///< [cm], [-]
        std::vector<float> values;                        ///< value of each position, as of the particles
        std::vector<Eigen::Vector3i> triangles;
    };
    struct Yarns {
        std::vector<Eigen::Vector3f> positions, directions;  ///< [cm], [-]
        std::vector<float> along, values, wetness;  ///< [cm]; values empty where the colour is that of the material, wetness [0..1] where all is dry
        std::vector<int> begin, materials;
        std::vector<std::array<float, 2>> halfAxes;  ///< [cm]
    };
    struct Cloth {
        std::vector<Eigen::Vector3f> positions;  ///< positions of all vertices of the fabric; empty without faces [cm]
        std::vector<Eigen::Vector3i> triangles;
        std::vector<float> thickness, values, wetness;  ///< thickness [cm]; values and wetness as of yarns
        std::vector<int> materials;
    };

    struct Lines {
        std::vector<Eigen::Vector3f> points;  ///< two per segment [cm]
        Eigen::Vector3f color = Eigen::Vector3f::Zero();
        float width = 1.5f;  ///< width and what follows, as in render::FrameView::Lines
        bool isTapered = false;
        float rim = 0.0f, lift = 0.0f;
    };

    std::int64_t number = 0;                 ///< 0 is the initial state
    double time = 0.0;                       ///< [s]
    std::uint64_t stateHash = 0;             ///< hash of the state that it is of
    std::vector<Eigen::Vector3f> positions;  ///< positions of the particles [cm]
    std::vector<float> values;               ///< one per position: its speed [cm/s] or pressure [dyn/cm^2]
    float radius = 0.0f;                     ///< radius of a particle [cm]
    Surface surface;                         ///< surface of the liquid; empty unless `extras` ask for it
    Yarns yarns;
    Cloth cloth;
    std::vector<Mesh> obstacles;
    std::vector<Lines> lines;
    SnapshotExtras extras;                                   ///< what it shows of all this
    std::vector<render::FrameView::Mesh> borrowedObstacles;  ///< obstacles as view() lends them
    std::vector<render::FrameView::Lines> borrowedLines;

    /// Valid until the snapshot changes.
    render::FrameView view();
};

}  // namespace app
