#include "app/export/geometry_files.h"

#include <fmt/format.h>

#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace app {

namespace fs = std::filesystem;

namespace {

/// The frame that a file of this name is of, if an Exporter writes such files, or had not finished one: −1 for files of all frames.
std::optional<std::int64_t> frameOfGeometry(const std::string& name)
{
    static const std::regex kPattern(R"((?:(?:liquid|surface|yarns|cloth|obstacle_\w+)(?:_(\d{5,})\.(?:vtp|ply)|\.pvd)|)"
                                     R"(frame_(\d{5,})\.(?:obj|usda)|(?:animation|topology)\.usda|provenance\.json)(?:\.part)?)");
    std::smatch match;
    if (!std::regex_match(name, match, kPattern)) return std::nullopt;
    const std::string digits = match[1].str() + match[2].str();
    return digits.empty() ? -1 : std::stoll(digits);
}

}  // namespace

fs::path geometryFolder(const fs::path& runFolder) { return runFolder / "geometry"; }

std::string geometryFileName(std::string_view part, std::int64_t frame, std::string_view extension)
{
    return fmt::format("{}_{:05}.{}", part, frame, extension);
}

std::vector<std::int64_t> geometryFrames(const fs::path& runFolder)
{
    std::set<std::int64_t> frames;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(geometryFolder(runFolder), none)) {
        const std::string name = entry.path().filename().string();
        if (const auto frame = frameOfGeometry(name); frame.value_or(-1) >= 0 && !name.ends_with(".part")) frames.insert(*frame);
    }
    return {frames.begin(), frames.end()};
}

void removeGeometryAfter(std::int64_t frame, const fs::path& runFolder)
{
    const fs::path folder = geometryFolder(runFolder);
    if (!fs::is_directory(folder)) return;
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto of = entry.is_regular_file() ? frameOfGeometry(entry.path().filename().string()) : std::nullopt;
        if (of && (*of > frame || frame < 0)) old.push_back(entry.path());
    }
    for (const auto& file : old) fs::remove(file);
    if (fs::is_empty(folder)) fs::remove(folder);
}

}  // namespace app
