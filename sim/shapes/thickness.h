#pragma once

#include "sim/shapes/shape.h"

namespace sim {

/// How thick the thin parts of a solid are: along the inward normal from places all over its surface, no more than `pitch` [cm] apart where the
/// shape is not larger than some tens of it, the length within the solid which a twentieth of them fall below [cm]. Infinite for shapes
/// without bounds and empty ones.
double thicknessOf(const Shape& shape, double pitch);

}  // namespace sim
