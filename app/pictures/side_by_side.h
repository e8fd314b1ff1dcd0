#pragma once

#include "app/backends.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace app {

/// The frames of one variant on disk.
struct FrameSequence {
    std::filesystem::path folder;
    std::string label;
    double start = 0.0, every = 0.0;   ///< simulated time of frame 0 and between frames [s]
    std::int64_t first = 0, last = 0;  ///< numbers of the frames that are there

    /// The frame nearest in time; the last one when the variant is over, the first one before it began.
    std::int64_t frameAt(double time) const;
};

/// Put frames of equal simulated time side by side, one picture per `every` until the longest sequence ends, into
/// folder/compare.mp4, or as PNGs into folder/side_by_side/ where there is no ffmpeg. Returns what it made; nothing if
/// stopWanted said so on the way.
std::filesystem::path composeSideBySide(const std::vector<FrameSequence>& sequences, double every, const PictureSettings& pictures,
                                        const Backends& backends, const std::filesystem::path& folder, const std::function<bool()>& stopWanted);

/// One row of an overview: variants of one scene at a time [s].
struct OverviewRow {
    std::vector<FrameSequence> sequences;
    PictureSettings pictures;
    double time = 0.0;
};

/// Rows of several scenes one below the other in one PNG; narrower ones are filled up with white.
void composeOverview(const std::vector<OverviewRow>& rows, const Backends& backends, const std::filesystem::path& file);

/// The contact sheet, folder/sheet.png: pictures of `rows` times, evenly spread from beginning to end, one below the other.
void composeSheet(const std::vector<FrameSequence>& sequences, int rows, const PictureSettings& pictures, const Backends& backends,
                  const std::filesystem::path& folder);

}  // namespace app
