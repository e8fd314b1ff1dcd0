#pragma once

#include "sim/scene/scene.h"

namespace sim {

/// Do all solids of the scene rest, hold the liquid, and have walls in planes of faces? At walls that go through cells the pressure pushes along their
/// normals in the sum over faces only, and what strains of that would push along the walls: a block on a frictionless slope of 45 degrees
/// became 14 % too fast.
bool hasWallsInPlanesOfFaces(const Scene& scene);

/// Is stretching within the reach of a B-spline no inertia to the pressure (liquid/README.md, Surface of second order)? In the whole scene or nowhere, so
/// that energies mean the same everywhere. Without air it is none in any case.
bool correctsStrain(const Scene& scene);

}  // namespace sim
