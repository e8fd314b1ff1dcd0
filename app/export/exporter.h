#pragma once

#include "app/export/export_frame.h"
#include "app/export/usda.h"
#include "app/export/vtp.h"
#include "app/picture_settings.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace app {

/// Writes the frames of one run into a folder, in all formats that are wanted. Every file is whole or not there, and
/// after every frame the collections (.pvd, animation.usda) name all frames so far: they may be opened while the run
/// goes on.
class Exporter {
 public:
    /// Makes the folder. What is in it of frames before the first that comes stays part of the collections. Throws InputError if it cannot
    /// be made.
    /// @param secondsPerFrame  simulated time from one number of a frame to the next [s]
    Exporter(std::filesystem::path folder, const GeometryFormats& formats, double secondsPerFrame);

    /// Frames come in order, with the same parts in each. Throws std::runtime_error when the disk takes no more.
    void write(const ExportFrame& frame);

 private:
    std::vector<std::int64_t> framesBefore(std::int64_t frame, const std::string& part, const std::string& extension) const;
    void writeVtp(const ExportFrame& frame);
    void writePly(const ExportFrame& frame) const;
    void writeUsda(const ExportFrame& frame);

    const std::filesystem::path folder_;
    const GeometryFormats formats_;
    const double secondsPerFrame_;
    std::map<std::string, std::vector<TimedFile>> collections_;  ///< of .vtp files: of each part, by its name
    std::vector<UsdaClip> clips_;
};

}  // namespace app
