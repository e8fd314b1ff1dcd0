#pragma once

#include "app/export/export_frame.h"

#include <string>

namespace app {

/// A frame as a Wavefront .obj file: each part as an object and group of its name, of faces, lines or points. The
/// format has no place for velocities and other quantities. Without normals, which some readers want for all faces or
/// for none. Lengths in cm, as a comment says.
std::string objFile(const ExportFrame& frame);

}  // namespace app
