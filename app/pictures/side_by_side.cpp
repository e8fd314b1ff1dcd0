#include "app/pictures/side_by_side.h"

#include "app/pictures/video.h"
#include "app/reports/output_folder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace app {

namespace {

RgbPicture pictureAt(double time, const std::vector<FrameSequence>& sequences, const PictureSettings& pictures, const Backends& backends)
{
    std::vector<Panel> panels;
    for (const auto& s : sequences) panels.push_back({s.folder / frameFileName(s.frameAt(time)), s.label});
    return backends.putSideBySide(panels, pictures, time);
}

/// When the first sequence begins and the last one ends [s].
std::pair<double, double> span(const std::vector<FrameSequence>& sequences)
{
    double start = sequences.front().start, end = start;
    for (const auto& s : sequences) {
        start = std::min(start, s.start);
        end = std::max(end, s.start + static_cast<double>(s.last) * s.every);
    }
    return {start, end};
}

/// Remove the pictures of an earlier comparison that had more of them.
void removeFrames(const std::filesystem::path& folder)
{
    for (std::int64_t n = 0; std::filesystem::remove(folder / frameFileName(n)); ++n) {
    }
}

}  // namespace

std::int64_t FrameSequence::frameAt(double time) const { return std::clamp<std::int64_t>(std::llround((time - start) / every), first, last); }

std::filesystem::path composeSideBySide(const std::vector<FrameSequence>& sequences, double every, const PictureSettings& pictures,
                                        const Backends& backends, const std::filesystem::path& folder, const std::function<bool()>& stopWanted)
{
    const auto [start, end] = span(sequences);
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
        const RgbPicture picture = pictureAt(start + static_cast<double>(n) * every, sequences, pictures, backends);
        if (!asVideo) {
            backends.writePng(picture, target / frameFileName(n));
            continue;
        }
        if (!video)
            video = std::make_unique<VideoWriter>(
                target,
                VideoFormat{.width = picture.width, .height = picture.height, .fps = pictures.output.videoFps, .codec = pictures.output.videoCodec});
        video->add(picture.rgb);
    }
    if (video) video->finish();
    return target;
}

void composeOverview(const std::vector<OverviewRow>& rows, const Backends& backends, const std::filesystem::path& file)
{
    std::vector<RgbPicture> pictures;
    RgbPicture all;
    for (const OverviewRow& row : rows) {
        pictures.push_back(pictureAt(row.time, row.sequences, row.pictures, backends));
        all.width = std::max(all.width, pictures.back().width);
    }
    for (const RgbPicture& picture : pictures) {
        const std::size_t from = std::size_t{3} * picture.width, to = std::size_t{3} * all.width;
        for (int y = 0; y < picture.height; ++y) {
            all.rgb.insert(all.rgb.end(), picture.rgb.begin() + y * from, picture.rgb.begin() + (y + 1) * from);
            all.rgb.insert(all.rgb.end(), to - from, 255);
        }
        all.height += picture.height;
    }
    backends.writePng(all, file);
}

void composeSheet(const std::vector<FrameSequence>& sequences, int rows, const PictureSettings& pictures, const Backends& backends,
                  const std::filesystem::path& folder)
{
    const auto [start, end] = span(sequences);
    RgbPicture sheet;
    for (int row = 0; row < rows; ++row) {
        const RgbPicture picture = pictureAt(std::lerp(start, end, row / std::max(1.0, rows - 1.0)), sequences, pictures, backends);
        sheet.width = picture.width;
        sheet.height += picture.height;
        sheet.rgb.insert(sheet.rgb.end(), picture.rgb.begin(), picture.rgb.end());
    }
    backends.writePng(sheet, folder / "sheet.png");
}

}  // namespace app
