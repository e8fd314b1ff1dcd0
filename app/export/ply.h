#pragma once

#include "app/export/export_frame.h"

#include <string>

namespace app {

/// A part as a binary .ply file, low byte first: vertices with x y z and a property for each number of each array (vx
/// vy vz, nx ny nz, else as the array is called), float or uint; then faces of triangles (vertex_indices) or edges of
/// lines (vertex1 vertex2). Units and the time [s] stand in comments.
std::string plyFile(const ExportPart& part, double time);

}  // namespace app
