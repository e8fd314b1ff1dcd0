#pragma once

#include "render/camera.h"

namespace app {

/// A camera that is moved by hand. Ways of the pointer are in pictures' heights, right and up positive.
class ViewCamera {
 public:
    explicit ViewCamera(const render::Camera& camera = {}) : camera_(camera) {}

    const render::Camera& camera() const { return camera_; }
    /// Turn about the target: half a turn per picture's height. The horizon stays level, the poles are not reached.
    void orbit(double right, double up);
    /// Move along the picture, so that what is at the target's depth stays under the pointer.
    void pan(double right, double up);
    /// Come nearer to the target for > 0, by a tenth per notch of a wheel.
    void zoom(double notches);
    /// See all of the box from the present side.
    void frame(const Eigen::AlignedBox3d& box, double aspect);

 private:
    render::Camera camera_;
};

}  // namespace app
