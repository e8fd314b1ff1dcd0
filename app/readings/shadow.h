#pragma once

#include "sim/core/types.h"

#include <span>

namespace app {

/// Area of the shadow of triangles in light along an axis [cm^2]: what several cover counts once.
double shadowArea(std::span<const sim::Vec3> points, std::span<const sim::Vec3i> faces, int axis);

}  // namespace app
