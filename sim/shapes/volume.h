#pragma once

#include "sim/shapes/shape.h"

namespace sim {

/// Volume of a bounded shape [cm^3], by quadrature of its distance: cells of about `cell` that the surface may cross
/// are cut into 8³, and each of those by the plane through which the distance passes zero. Exact for boxes; about 4e-3
/// (cell / radius)² for round ones. Throws InputError for an unbounded shape.
double boundedVolume(const Shape& shape, double cell);

}  // namespace sim
