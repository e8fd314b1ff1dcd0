#pragma once

#include "app/export/export_frame.h"
#include "app/export/vtp.h"
#include "app/picture_settings.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace app {

/// Writes the frames of one run into a folder, in all formats that are wanted. Every file is whole or not there, and
/// after every frame the collections name all frames so far: they may be opened while the run goes on.
class Exporter {
 public:
    /// Makes the folder. What it holds of frames before the first that comes stays part of the collections.
    /// @param timeOf  the time of a frame [s]
    /// Throws std::runtime_error if it cannot be made.
    Exporter(std::filesystem::path folder, const GeometryFormats& formats, std::function<double(std::int64_t)> timeOf);

    /// Frames come in order. Throws std::runtime_error when the disk takes no more.
    void write(const ExportFrame& frame);

 private:
    void writeVtp(const ExportFrame& frame);

    const std::filesystem::path folder_;
    const GeometryFormats formats_;
    const std::function<double(std::int64_t)> timeOf_;
    std::map<std::string, std::vector<TimedFile>> collections_;  ///< of each part, by its name
};

}  // namespace app
