#pragma once

#include "app/scene/picture_settings.h"
#include "app/system/child_process.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace app {

/// Is there an ffmpeg to make videos with?
bool canMakeVideos();

/// Version of that ffmpeg, in its own words. Needs canMakeVideos().
std::string videoProgramVersion();

/// Players give up on wider videos: wider pictures are scaled down to it [pixels].
inline constexpr int kMaxVideoWidth = 4096;

struct VideoFormat {
    int width = 0, height = 0;  ///< size of the pictures [pixels]; see kMaxVideoWidth. An odd edge gains a white line
    double fps = 50.0;
    std::string codec = "libx264";
};

/// An MP4 that grows picture by picture, through the program ffmpeg. Pictures are written as rows of RGB, top row first.
/// The file takes its name in finish(). Throws std::runtime_error with ffmpeg's own words.
class VideoWriter {
 public:
    /// Needs canMakeVideos().
    VideoWriter(std::filesystem::path target, const VideoFormat& format);
    ~VideoWriter();
    void add(std::span<const std::uint8_t> rgb);
    void finish();

 private:
    [[noreturn]] void fail();
    std::filesystem::path target_, part_;
    std::size_t pictureBytes_;
    std::unique_ptr<ChildProcess> ffmpeg_;
};

/// An MP4 of the pictures frame_00000.png, frame_00001.png, … in a folder, from the first one there is.
void videoOfFrames(const std::filesystem::path& folder, const std::filesystem::path& target, double fps, const std::string& codec);

/// Makes video.mp4 of a folder's pictures, in the folder; without ffmpeg a warning says where the pictures are.
void makeVideo(const std::filesystem::path& folder, const OutputSettings& output);

}  // namespace app
