#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace render {

/// Where the picture is taken from. Right-handed world; lengths in cm, angles in degrees as scenes give them.
struct Camera {
    Eigen::Vector3d eye = {0.0, 0.0, 100.0};           ///< [cm]
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< the point in the middle of the picture [cm]
    Eigen::Vector3d up = Eigen::Vector3d::UnitY();     ///< need not be perpendicular to the view
    double fovDegrees = 40.0;                          ///< vertical field of view, in (0, 180)
};

/// A camera on a sphere about the target: azimuth 0 looks along −z, grows to the right (eye towards +x);
/// elevation lifts the eye, in (−90, 90).
Camera orbitCamera(const Eigen::Vector3d& target, double distance, double azimuthDegrees, double elevationDegrees, double fovDegrees = 40.0);

/// The direction of `camera`, moved so that the ball about the box fills the smaller side of the picture:
/// radius = half diagonal, distance = radius / sin(fov / 2). The picture does not jump when the camera turns.
/// An empty box leaves the camera as it is; a single point is seen from 1 cm.
Camera frameBall(const Eigen::AlignedBox3d& box, double aspect, const Camera& camera = {});

/// The direction of `camera`, as near to the box as its eight corners allow, `margin` (a share of the picture) free on each side.
/// For still cameras: flat things fill the picture better.
Camera frameBox(const Eigen::AlignedBox3d& box, double aspect, const Camera& camera = {}, double margin = 0.06);

/// World to eye space: eye at the origin, looking along −z, y up.
/// Throws std::invalid_argument if eye and target coincide or up is parallel to the view.
Eigen::Isometry3d viewTransform(const Camera& camera);

/// Eye space to clip space, depth −1 at zNear and 1 at zFar (distances > 0 in front of the eye) [cm].
Eigen::Matrix4d projection(const Camera& camera, double aspect, double zNear, double zFar);

}  // namespace render
