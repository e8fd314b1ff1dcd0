#pragma once

#include "sim/scene/scene.h"

namespace sim {

/// Has the scene air, and only walls that mirror the liquid: of resting boxes around it, in planes of faces, along which it slips? At walls that go
/// through cells the pressure pushes along their normals in the sum over faces only, and what strains of that would push along the walls: a block
/// on a frictionless slope of 45 degrees became 14 % too fast. Walls that liquid sticks to do not mirror it, and count as those.
bool canCorrectStrain(const Scene& scene);

/// Is stretching within the reach of a B-spline no inertia to the pressure (liquid/README.md, Surface of second order)? In the whole scene or
/// nowhere, so that energies mean the same everywhere.
bool correctsStrain(const Scene& scene);

}  // namespace sim
