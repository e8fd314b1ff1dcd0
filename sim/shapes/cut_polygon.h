#pragma once

#include "sim/core/types.h"

#include <span>
#include <vector>

namespace sim {

/// Adds the triangles of a polygon, all of whose corners they have, and none that lies outside of it: a fan from the
/// first corner where it is convex, else by cutting off ears. The polygon is nearly plane and may not cross itself.
void cutPolygon(const std::vector<Vec3>& vertices, std::span<const int> corners, std::vector<Vec3i>& triangles);

}  // namespace sim
