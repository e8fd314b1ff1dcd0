#pragma once

#include "sim/shapes/shape.h"
#include "sim/shapes/triangle_mesh.h"

#include <filesystem>

namespace sim {

/// The `v` and `f` lines of a Wavefront OBJ file, the others skipped. Faces may have any number of corners (cut into a
/// fan), written as `1`, `1/2`, `1//3` or `1/2/3`, counted from 1, or backwards from −1. Throws InputError "file:line:
/// what".
TriangleMesh readObj(const std::filesystem::path& file);

/// The closed mesh in an OBJ file, times `scale` (the file's unit in cm), sampled on a lattice of pitch `cell` [cm].
Shape shapeFromObj(const std::filesystem::path& file, double scale, double cell);

}  // namespace sim
