#pragma once

#include "sim/shapes/shape.h"

#include <span>
#include <vector>

namespace sim {

/// Volumes of particles that fill a region evenly, as the faces of the grid see it: the quadratic B-splines of the particles around a face sum up to
/// the part of the face's B-spline that lies in the region (sources/README.md, Filling). The same bits for any number of threads.
/// @param volume  of the region [cm³]
/// @param dx      cell of the grid [cm]
/// @param origin  lower corner of cell (0, 0, 0) [cm]
/// @return        volume of each particle [cm³], all above 0; their sum is `volume`
std::vector<double> evenVolumes(const Shape& region, std::span<const Vec3> positions, double volume, double dx, const Vec3& origin);

}  // namespace sim
