#include "app/export/geometry_files.h"

#include <fmt/format.h>

#include <regex>
#include <vector>

namespace app {

namespace fs = std::filesystem;

namespace {

/// Is this the name of a file that an Exporter writes, or of one it had not finished?
bool isGeometryFile(const std::string& name)
{
    static const std::regex kPattern(
        R"(((liquid|yarns|cloth|obstacle_\w+)(_\d{5,}\.(vtp|ply)|\.pvd)|frame_\d{5,}\.(obj|usda)|(animation|topology)\.usda)(\.part)?)");
    return std::regex_match(name, kPattern);
}

}  // namespace

fs::path geometryFolder(const fs::path& runFolder)
{
    return runFolder / "geometry";
}

std::string geometryFileName(std::string_view part, std::int64_t frame, std::string_view extension)
{
    return fmt::format("{}_{:05}.{}", part, frame, extension);
}

void removeGeometry(const fs::path& runFolder)
{
    const fs::path folder = geometryFolder(runFolder);
    if (!fs::is_directory(folder)) return;
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && isGeometryFile(entry.path().filename().string())) old.push_back(entry.path());
    for (const auto& file : old) fs::remove(file);
    if (fs::is_empty(folder)) fs::remove(folder);
}

}  // namespace app
