#pragma once

#include "app/export/export_frame.h"
#include "app/scene/picture_settings.h"

#include <filesystem>
#include <vector>

namespace app {

/// Writes the frames of one run into a folder, in all formats that are wanted. Every file is whole or not there, and
/// after every frame the collections (.pvd, animation.usda) name all frames so far: they may be opened while the run
/// goes on.
class Exporter {
 public:
    /// Makes the folder. Throws InputError if it cannot be made.
    /// @param secondsPerFrame  simulated time from one number of a frame to the next [s]
    /// @param earlier          frames that an earlier Exporter has left there, for a run that goes on: collections name
    /// them too
    Exporter(std::filesystem::path folder, const GeometryFormats& formats, double secondsPerFrame, std::vector<FrameTime> earlier = {});

    /// Frames come in order, with the same parts in each. Throws std::runtime_error when the disk takes no more.
    void write(const ExportFrame& frame);

 private:
    void writeVtp(const ExportFrame& frame) const;
    void writePly(const ExportFrame& frame) const;
    void writeUsda(const ExportFrame& frame) const;

    const std::filesystem::path folder_;
    const GeometryFormats formats_;
    const double secondsPerFrame_;
    std::vector<FrameTime> frames_;  ///< so far
};

}  // namespace app
