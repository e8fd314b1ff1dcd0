#include "app/pictures/video.h"

#include "app/system/atomic_files.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <stdexcept>
#include <vector>

namespace app {

namespace {

/// Arguments that turn decoded pictures into a file any player takes. crf 16 shows no blocks in smooth colours.
std::vector<std::string> outputArguments(const std::string& codec, const std::filesystem::path& part)
{
    // The comma inside min() is ffmpeg's own separator unless it is escaped; pictures that fit are left as they are.
    const std::string fit = fmt::format("scale=w='min(iw\\,{0})':h='if(gt(iw\\,{0})\\,-2\\,ih)'", kMaxVideoWidth);
    return {"-an",
            "-c:v",
            codec,
            "-crf",
            "16",
            "-preset",
            "medium",
            "-pix_fmt",
            "yuv420p",
            "-vf",
            fit + ",pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white",
            "-movflags",
            "+faststart",
            "-f",
            "mp4",
            part.string()};
}

std::vector<std::string> ffmpegArguments(std::vector<std::string> input, const std::vector<std::string>& output)
{
    std::vector<std::string> all = {"-hide_banner", "-loglevel", "error", "-y"};
    all.insert(all.end(), input.begin(), input.end());
    all.insert(all.end(), output.begin(), output.end());
    return all;
}

std::filesystem::path ffmpegProgram()
{
    const auto program = findProgram("ffmpeg");
    if (!program) throw std::runtime_error("no ffmpeg along PATH: install it to get videos");
    return *program;
}

[[noreturn]] void throwNoVideo(const std::filesystem::path& target, const ChildExit& end)
{
    throw std::runtime_error(fmt::format("ffmpeg could not write {}: {}", target.string(), end.lastWords()));
}

}  // namespace

bool canMakeVideos() { return findProgram("ffmpeg").has_value(); }

std::string videoProgramVersion()
{
    // Called without arguments it says "ffmpeg version 5.1.6-0+deb12u1 Copyright …" before it complains.
    constexpr std::string_view kBegin = "ffmpeg version ";
    const std::string words = runChild(ffmpegProgram(), {}).errorText;
    if (!words.starts_with(kBegin)) return "unknown";
    const std::size_t end = words.find_first_of(" \n", kBegin.size());
    return words.substr(kBegin.size(), end == std::string::npos ? end : end - kBegin.size());
}

VideoWriter::VideoWriter(std::filesystem::path target, const VideoFormat& format)
    : target_(std::move(target)),
      part_(partFile(target_)),
      pictureBytes_(std::size_t{3} * static_cast<std::size_t>(format.width) * static_cast<std::size_t>(format.height))
{
    const auto arguments = ffmpegArguments({"-f", "rawvideo", "-pix_fmt", "rgb24", "-s", fmt::format("{}x{}", format.width, format.height),
                                            "-framerate", fmt::format("{}", format.fps), "-i", "pipe:0"},
                                           outputArguments(format.codec, part_));
    ffmpeg_ = std::make_unique<ChildProcess>(ffmpegProgram(), arguments, ChildOptions{.folder = {}, .quiet = true, .feed = true});
}

VideoWriter::~VideoWriter()
{
    if (!ffmpeg_) return;
    ffmpeg_.reset();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void VideoWriter::add(std::span<const std::uint8_t> rgb)
{
    if (rgb.size() != pictureBytes_) throw std::invalid_argument("a video's pictures must all have its size");
    if (!ffmpeg_->write(rgb)) fail();
}

void VideoWriter::finish()
{
    const ChildExit end = ffmpeg_->wait();
    ffmpeg_.reset();
    if (!end.ok()) throwNoVideo(target_, end);
    putInPlace(part_, target_);
}

void VideoWriter::fail()
{
    const ChildExit end = ffmpeg_->wait();
    ffmpeg_.reset();
    throwNoVideo(target_, end);
}

void videoOfFrames(const std::filesystem::path& folder, const std::filesystem::path& target, double fps, const std::string& codec)
{
    const std::vector<std::int64_t> frames = numbersIn(folder, "frame_", ".png");
    if (frames.empty()) throw std::runtime_error(fmt::format("cannot write {}: there are no pictures", target.string()));
    // The pattern stands alone and ffmpeg runs in the folder, whose own name may hold a '%'.
    const auto part = std::filesystem::absolute(partFile(target));
    const auto arguments =
        ffmpegArguments({"-framerate", fmt::format("{}", fps), "-start_number", fmt::format("{}", frames.front()), "-i", "frame_%05d.png"},
                        outputArguments(codec, part));
    const ChildExit end = runChild(ffmpegProgram(), arguments, {.folder = folder});
    if (!end.ok()) throwNoVideo(target, end);
    putInPlace(part, target);
}

void makeVideo(const std::filesystem::path& folder, const OutputSettings& output)
{
    if (canMakeVideos()) videoOfFrames(folder, folder / "video.mp4", output.videoFps, output.videoCodec);
    else spdlog::warn("no ffmpeg along PATH, so no video: the pictures are in {}", folder.string());
}

}  // namespace app
