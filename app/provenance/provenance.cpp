#include "app/provenance/provenance.h"

#include "app/checkpoint/hdf5_image.h"
#include "app/pictures/video.h"
#include "app/provenance/build_info.h"
#include "app/system/atomic_files.h"
#include "app/system/child_process.h"
#include "app/system/thread_limit.h"
#include "sim/core/vector_bits.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <chrono>
#include <fstream>

namespace app {

namespace {

using ProvenanceJson = nlohmann::ordered_json;

/// The command line of this process, as a shell reads it.
std::string commandLine()
{
    const std::string words = readWhole("/proc/self/cmdline");  // each ends with a zero
    std::string line;
    for (std::size_t begin = 0; begin < words.size();) {
        const std::size_t end = std::min(words.find('\0', begin), words.size());
        if (!line.empty()) line += ' ';
        line += shellQuoted(words.substr(begin, end - begin));
        begin = end + 1;
    }
    return line;
}

ProvenanceJson librariesJson(const std::string& drawnBy)
{
    ProvenanceJson libraries = {{"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
                                {"glibc", gnu_get_libc_version()},
                                {"hdf5", hdf5Version()},
                                {"tbb", tbbVersion()}};
    if (drawnBy.empty()) return libraries;
    libraries["opengl"] = drawnBy;
    libraries["ffmpeg"] = canMakeVideos() ? videoProgramVersion() : "none";
    return libraries;
}

ProvenanceJson sceneJson(const LoadedScene& setup)
{
    ProvenanceJson texts = ProvenanceJson::object();
    for (const sim::SceneText& text : setup.file.texts) texts[text.file] = text.text;
    return {{"file", setup.request.file},
            {"variant", setup.request.variant},
            {"overrides", setup.request.sets},
            {"texts", texts},
            {"resolved", setup.resolved}};
}

}  // namespace

std::string programName() { return fmt::format("Drench {} ({})", DRENCH_VERSION, kBuildInfo.commit); }

std::string processorName()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) {
            const std::size_t begin = line.find_first_not_of(" \t", line.find(':') + 1);
            return begin == std::string::npos ? "unknown" : line.substr(begin);
        }
    return "unknown";
}

std::string provenanceOf(const LoadedScene& setup, int threads, const std::string& drawnBy, const std::string& before)
{
    const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
    ProvenanceJson json = {{"version", DRENCH_VERSION},
                           {"commit", kBuildInfo.commit},
                           {"compiler", kBuildInfo.compiler},
                           {"flags", kBuildInfo.flags},
                           {"processor", processorName()},
                           {"vector_bits", sim::kVectorBits},
                           {"threads", threads},
                           {"libraries", librariesJson(drawnBy)},
                           {"command", commandLine()},
                           {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))},
                           {"scene", sceneJson(setup)}};
    if (!before.empty()) json["made_from"] = ProvenanceJson::parse(before);
    return json.dump(-1, ' ', false, ProvenanceJson::error_handler_t::replace);  // a command line may have any bytes
}

}  // namespace app
