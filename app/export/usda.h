#pragma once

#include "app/export/export_frame.h"

#include <span>
#include <string>

// A run as USD, in text. In layers that lie over one another the strongest one alone gives the time samples of an
// attribute: they do not add up. So every frame is a layer of its own with samples at its time code, and animation.usda
// plays them one after the other as value clips. What the prims are stands in topology.usda, which is below
// animation.usda and is the manifest of its clips. Time codes are numbers of frames, of which 1 / (seconds per frame)
// are a second. Open animation.usda; a frame alone opens too.

namespace app {

/// Names of the layers' files.
inline constexpr const char* kUsdaAnimation = "animation.usda";
inline constexpr const char* kUsdaTopology = "topology.usda";

/// One frame: liquid as Points, lines as BasisCurves, triangles as Mesh, with velocities [cm/s], widths [cm], ids,
/// normals, and everything else as primvars.
/// @param secondsPerFrame  simulated time from one number of a frame to the next [s]
std::string usdaFrame(const ExportFrame& frame, double secondsPerFrame);

/// The prims of these parts and their attributes, without values.
std::string usdaTopology(std::span<const ExportPart> parts, double secondsPerFrame);

/// All frames, at least one, in the order of their numbers, each in its file.
std::string usdaAnimation(std::span<const FrameTime> frames, double secondsPerFrame);

}  // namespace app
