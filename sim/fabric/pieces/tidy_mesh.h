#pragma once

#include "sim/fabric/pieces/generators.h"

#include <string>
#include <vector>

namespace sim {

/// Drops what is not used of a mesh from a file, joins what is at one place, and says so, a line each.
/// @param distance  of corners that are one [cm]; 0: none are; negative: the mesh's own
std::vector<std::string> tidyMesh(FabricGeometry& mesh, double distance);

}  // namespace sim
