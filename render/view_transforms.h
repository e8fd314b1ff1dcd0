#pragma once

#include "render/camera.h"

#include <Eigen/Core>

namespace render {

/// What every shader needs to know of the camera, for one picture.
struct ViewTransforms {
    Eigen::Matrix4f view;             ///< world → eye
    Eigen::Matrix4f projection;       ///< eye → clip
    Eigen::Vector3f eye;              ///< [cm]
    float zNear = 0.0f, zFar = 0.0f;  ///< [cm]
    int width = 0, height = 0;        ///< [pixels]

    /// Height in pixels of something 1 cm high at 1 cm from the eye.
    float pixelsPerTangent() const { return 0.5f * static_cast<float>(height) * projection(1, 1); }
};

}  // namespace render
