#pragma once

#include "app/export/export_frame.h"

#include <span>
#include <string>
#include <string_view>

namespace app {

inline constexpr const char* kVtpExtension = "vtp";

/// A part as a file of VTK's polygonal data (.vtp): XML with its numbers behind it in binary, compressed by zlib, with
/// headers of 64 bits. Positions and arrays are Float32, whole numbers UInt32; the time [s] is in the field array
/// TimeValue. Units stand in a comment.
std::string vtpFile(const ExportPart& part, double time);

/// The collection of the .vtp files of one part (.pvd), which ParaView opens as one thing that changes over time.
std::string pvdFile(std::string_view part, std::span<const FrameTime> frames);

}  // namespace app
