#pragma once

#include "sim/shapes/triangle_mesh.h"

#include <string>
#include <vector>

namespace sim {

/// Gives vertices within `distance` [cm] of an earlier one its number. Returns for each vertex the number that it has now.
std::vector<int> weldedNumbers(const std::vector<Vec3>& vertices, double distance);

/// Makes the surface of a solid of a mesh: faces of a part that are turned against each other are turned alike, parts
/// that are turned inside out are turned with all that is inside of them; cavities stay. Corners at one place count as
/// one. Holes up to `largestHole` [cm] across are left as they are. Returns what was done, "" if nothing was.
/// Throws InputError for a mesh that is open, that has one side only, or edges that an odd number of faces share.
std::string mendSolid(TriangleMesh& mesh, double largestHole);

}  // namespace sim
