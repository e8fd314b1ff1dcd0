#pragma once

#include "sim/shapes/shape.h"
#include "sim/shapes/triangle_mesh.h"

#include <filesystem>

namespace sim {

/// The `v` and `f` lines of a Wavefront OBJ file, the others skipped. Faces may have any number of corners (cut
/// into triangles), written as `1`, `1/2`, `1//3` or `1/2/3`, counted from 1, or backwards from −1. Throws InputError "file:line:
/// what".
TriangleMesh readObj(const std::filesystem::path& file);

/// Points and the lines through them.
struct PolylineSet {
    std::vector<Vec3> vertices;           ///< [cm]
    std::vector<std::vector<int>> lines;  ///< vertices in order, 2 or more
};

/// The `v` and `l` lines of a Wavefront OBJ file, the others skipped; corners as in readObj.
PolylineSet readObjLines(const std::filesystem::path& file);

/// The closed mesh in an OBJ file, times `scale` (the file's unit in cm), sampled on a lattice of pitch `cell` [cm];
/// `notes` as in Shape::mesh.
Shape shapeFromObj(const std::filesystem::path& file, double scale, double cell, std::vector<std::string>* notes = nullptr);

}  // namespace sim
