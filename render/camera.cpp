#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace render {

namespace {

using Eigen::Vector3d;

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Tangents of half the vertical and half the horizontal field of view.
struct HalfTangents {
    HalfTangents(const Camera& camera, double aspect) : vertical(std::tan(0.5 * radians(camera.fovDegrees))), horizontal(vertical * aspect) {}
    double vertical, horizontal;
};

Camera lookingAt(const Vector3d& target, double distance, const Camera& camera)
{
    Camera moved = camera;
    moved.target = target;
    moved.eye = target + distance * (camera.eye - camera.target).normalized();
    return moved;
}

}  // namespace

Camera orbitCamera(const Vector3d& target, double distance, double azimuthDegrees, double elevationDegrees, double fovDegrees)
{
    const double azimuth = radians(azimuthDegrees), elevation = radians(elevationDegrees);
    const Vector3d towardsEye = {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)};
    return {target + distance * towardsEye, target, Vector3d::UnitY(), fovDegrees};
}

Camera frameBall(const Eigen::AlignedBox3d& box, double aspect, const Camera& camera)
{
    if (box.isEmpty()) return camera;
    const HalfTangents tangents(camera, aspect);
    const double halfAngle = std::atan(std::min(tangents.vertical, tangents.horizontal));
    const double radius = 0.5 * box.diagonal().norm();
    return lookingAt(box.center(), radius > 0.0 ? radius / std::sin(halfAngle) : 1.0, camera);
}

Camera frameBox(const Eigen::AlignedBox3d& box, double aspect, const Camera& camera, double margin)
{
    if (box.isEmpty()) return camera;
    const HalfTangents tangents(camera, aspect);
    const double free = 1.0 - 2.0 * margin;
    const Eigen::Matrix3d toEye = viewTransform(camera).linear();

    // A corner at c (eye axes, about the centre) is seen inside the picture from distances ≥ c.z + |c.xy| / tangent.
    double distance = 0.0;
    for (int i = 0; i < 8; ++i) {
        const auto corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
        const Vector3d c = toEye * (corner - box.center());
        distance = std::max({distance, c.z() + std::abs(c.x()) / (free * tangents.horizontal), c.z() + std::abs(c.y()) / (free * tangents.vertical)});
    }
    return lookingAt(box.center(), distance > 0.0 ? distance : 1.0, camera);
}

Eigen::Isometry3d viewTransform(const Camera& camera)
{
    const Vector3d back = (camera.eye - camera.target).normalized();
    const Vector3d right = camera.up.cross(back).normalized();
    if (!(back.squaredNorm() > 0.5) || !(right.squaredNorm() > 0.5))
        throw std::invalid_argument("camera: eye and target coincide, or up is parallel to the view");
    Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
    view.linear().row(0) = right;
    view.linear().row(1) = back.cross(right);
    view.linear().row(2) = back;
    view.translation() = -view.linear() * camera.eye;
    return view;
}

Eigen::Matrix4d projection(const Camera& camera, double aspect, double zNear, double zFar)
{
    const HalfTangents tangents(camera, aspect);
    Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
    clip(0, 0) = 1.0 / tangents.horizontal;
    clip(1, 1) = 1.0 / tangents.vertical;
    clip(2, 2) = -(zFar + zNear) / (zFar - zNear);
    clip(2, 3) = -2.0 * zFar * zNear / (zFar - zNear);
    clip(3, 2) = -1.0;
    return clip;
}

}  // namespace render
