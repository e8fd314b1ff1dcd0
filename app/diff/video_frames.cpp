#include "app/diff/video_frames.h"

#include "app/system/child_process.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace app {

namespace fs = std::filesystem;

namespace {

void takeFramesOut(const fs::path& video, const fs::path& folder)
{
    const auto ffmpeg = findProgram("ffmpeg");
    if (!ffmpeg)
        throw std::runtime_error(
            fmt::format("{}: no ffmpeg along PATH to take its frames out; install it, or compare folders of pictures", video.string()));
    fs::create_directories(folder);
    const ChildExit end = runChild(*ffmpeg,
                                   {"-hide_banner", "-loglevel", "error", "-i", fs::absolute(video).string(), "-vsync", "passthrough",
                                    "-start_number", "0", "-compression_level", "1", "frame_%05d.png"},
                                   {.folder = folder});
    if (!end.ok()) throw std::runtime_error(fmt::format("ffmpeg cannot read {}: {}", video.string(), end.lastWords()));
}

}  // namespace

VideoFrames::VideoFrames(const fs::path& videoA, const fs::path& videoB)
{
    std::string name = (fs::temp_directory_path() / "drench_frames_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(fmt::format("cannot make a folder {}: {}", name, std::strerror(errno)));
    folder_ = name;
    try {
        takeFramesOut(videoA, a());
        takeFramesOut(videoB, b());
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
        throw;
    }
}

VideoFrames::~VideoFrames()
{
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

}  // namespace app
