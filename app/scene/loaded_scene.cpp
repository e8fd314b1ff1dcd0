#include "app/scene/loaded_scene.h"

#include "app/system/atomic_files.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <xxhash.h>

#include <cmath>

namespace app {

std::string hexDigits(std::uint64_t value) { return fmt::format("{:016x}", value); }

void logNotes(const LoadedScene& setup)
{
    for (const std::string& note : setup.scene.notes) spdlog::warn("{}", note);
}

std::string contentHash(const LoadedScene& setup, bool asPanel, std::uint64_t programHash)
{
    const std::string all = fmt::format("{}\n{}\n{}\n{}", setup.variant, setup.label, asPanel ? "panel" : "picture", setup.identity);
    return hexDigits(XXH64(all.data(), all.size(), programHash));
}

std::uint64_t programHash()
{
    static const std::uint64_t hash = [] {
        const std::string program = readWhole("/proc/self/exe");
        return XXH64(program.data(), program.size(), 0);
    }();
    return hash;
}

namespace {

std::filesystem::path filledIn(const LoadedScene& setup, const std::string& name, const std::string& variant)
{
    std::string folder = setup.pictures.output.dir.empty() ? "out/{name}/{variant}" : setup.pictures.output.dir;
    const auto fillIn = [&](const std::string& word, const std::string& value) {
        for (std::size_t at = 0; (at = folder.find(word, at)) != std::string::npos; at += value.size()) folder.replace(at, word.size(), value);
    };
    fillIn("{name}", name);
    fillIn("{variant}", variant);
    return folder;
}

}  // namespace

std::filesystem::path defaultFolder(const LoadedScene& setup) { return filledIn(setup, setup.scene.name, setup.variant); }

std::filesystem::path defaultComparisonFolder(const LoadedScene& setup)
{
    const std::string& own = setup.pictures.compare.name;
    const auto folder = filledIn(setup, own.empty() ? setup.scene.name : own, "").lexically_normal();
    return folder.has_filename() ? folder : folder.parent_path();
}

std::int64_t lastFrameUpTo(const LoadedScene& setup, double time)
{
    // A time that is a whole number of frames but for rounding has its frame.
    constexpr double kRounding = 1.0e-9;
    return std::llround(std::floor((time - setup.scene.settings.time.start) / setup.pictures.output.every + kRounding));
}

std::int64_t frameCount(const LoadedScene& setup)
{
    const auto& time = setup.scene.settings.time;
    return lastFrameUpTo(setup, time.start + time.duration);
}

double frameTime(const LoadedScene& setup, std::int64_t frame)
{
    return setup.scene.settings.time.start + static_cast<double>(frame) * setup.pictures.output.every;
}

}  // namespace app
