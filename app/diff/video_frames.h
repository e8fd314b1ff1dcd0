#pragma once

#include <filesystem>

namespace app {

/// The frames of two videos as pictures, in a folder of their own that goes when this does.
class VideoFrames {
 public:
    /// Needs ffmpeg. Throws std::runtime_error with its words.
    VideoFrames(const std::filesystem::path& videoA, const std::filesystem::path& videoB);
    ~VideoFrames();
    VideoFrames(const VideoFrames&) = delete;
    VideoFrames& operator=(const VideoFrames&) = delete;

    std::filesystem::path a() const { return folder_ / "a"; }
    std::filesystem::path b() const { return folder_ / "b"; }

 private:
    std::filesystem::path folder_;
};

}  // namespace app
