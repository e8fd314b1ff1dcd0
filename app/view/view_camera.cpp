#include "app/view/view_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace app {

namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kNearestPole = 0.02;  ///< [rad]

}  // namespace

void ViewCamera::orbit(double right, double up)
{
    const Vector3d pole = camera_.up.normalized();
    const Vector3d arm = camera_.eye - camera_.target;
    const double fromPole = std::acos(std::clamp(arm.normalized().dot(pole), -1.0, 1.0));
    // Dragging up looks from further below: the scene follows the pointer.
    const double turned = std::clamp(fromPole + kPi * up, kNearestPole, kPi - kNearestPole) - fromPole;
    const Vector3d level = pole.cross(arm).normalized();
    const Vector3d tilted = Eigen::AngleAxisd(turned, level) * arm;
    camera_.eye = camera_.target + Eigen::AngleAxisd(-kPi * right, pole) * tilted;
}

void ViewCamera::pan(double right, double up)
{
    const Vector3d ahead = camera_.target - camera_.eye;
    const Vector3d side = ahead.cross(camera_.up).normalized(), above = side.cross(ahead).normalized();
    const double height = 2.0 * ahead.norm() * std::tan(camera_.fovDegrees * kPi / 360.0);  // of the picture at the target
    const Vector3d way = -height * (right * side + up * above);
    camera_.eye += way;
    camera_.target += way;
}

void ViewCamera::zoom(double notches)
{
    constexpr double kNotch = 0.9;
    camera_.eye = camera_.target + std::pow(kNotch, notches) * (camera_.eye - camera_.target);
}

void ViewCamera::frame(const Eigen::AlignedBox3d& box, double aspect) { camera_ = render::frameBox(box, aspect, camera_); }

}  // namespace app
