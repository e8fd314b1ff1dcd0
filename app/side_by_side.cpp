#include "app/side_by_side.h"

#include "app/output_folder.h"
#include "app/video.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace app {

namespace {

SideBySide pictureAt(double time, const std::vector<FrameSequence>& sequences, const PictureSettings& pictures, const Parts& parts)
{
    std::vector<Panel> panels;
    for (const auto& s : sequences) panels.push_back({s.folder / frameFileName(s.frameAt(time)), s.label});
    return parts.putSideBySide(panels, pictures, time);
}

/// Remove the pictures of an earlier comparison that had more of them.
void removeFrames(const std::filesystem::path& folder)
{
    for (std::int64_t n = 0; std::filesystem::remove(folder / frameFileName(n)); ++n) {}
}

}  // namespace

std::int64_t FrameSequence::frameAt(double time) const
{
    return std::clamp<std::int64_t>(std::llround((time - start) / every), 0, last);
}

std::filesystem::path composeSideBySide(const std::vector<FrameSequence>& sequences, double every, const PictureSettings& pictures,
                                        const Parts& parts, const std::filesystem::path& folder,
                                        const std::function<bool()>& stopWanted)
{
    double start = sequences.front().start, end = start;
    for (const auto& s : sequences) {
        start = std::min(start, s.start);
        end = std::max(end, s.start + static_cast<double>(s.last) * s.every);
    }
    const bool asVideo = canMakeVideos();
    const auto target = folder / (asVideo ? "compare.mp4" : "side_by_side");
    if (!asVideo) {
        spdlog::warn("no ffmpeg along PATH, so no video: the pictures are in {}", target.string());
        makeFolder(target);
        removeFrames(target);
    }
    std::unique_ptr<VideoWriter> video;
    const std::int64_t pictureCount = std::llround((end - start) / every) + 1;
    for (std::int64_t n = 0; n < pictureCount; ++n) {
        if (stopWanted()) return {};
        const SideBySide picture = pictureAt(start + static_cast<double>(n) * every, sequences, pictures, parts);
        if (!asVideo) {
            picture.writePng(target / frameFileName(n));
            continue;
        }
        if (!video)
            video = std::make_unique<VideoWriter>(target, VideoFormat{.width = picture.width, .height = picture.height,
                                                                      .fps = pictures.output.videoFps, .codec = pictures.output.videoCodec});
        video->add(picture.rgb);
    }
    if (video) video->finish();
    return target;
}

}  // namespace app
