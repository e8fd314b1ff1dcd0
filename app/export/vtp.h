#pragma once

#include "app/export/export_frame.h"

#include <filesystem>
#include <span>
#include <string>

namespace app {

/// A part as a file of VTK's polygonal data (.vtp): XML with its numbers behind it in binary, compressed by zlib, with
/// headers of 64 bits. Positions and arrays are Float32, whole numbers UInt32; the time [s] is in the field array
/// TimeValue. Units stand in a comment.
std::string vtpFile(const ExportPart& part, double time);

/// A file of a part and its time [s].
struct TimedFile {
    double time = 0.0;
    std::filesystem::path file;  ///< below the folder of the collection
};

/// The collection of the files of one part (.pvd), which ParaView opens as one thing that changes over time.
std::string pvdFile(std::span<const TimedFile> files);

}  // namespace app
