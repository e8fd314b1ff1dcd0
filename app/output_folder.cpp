#include "app/output_folder.h"

#include "app/export/geometry_files.h"
#include "app/output_files.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 5> kRunFiles = {"report.json", "steps.jsonl", "energy.csv", "video.mp4", "resolved.yaml"};

bool isFrame(std::string_view name)
{
    constexpr std::string_view kHead = "frame_", kTail = ".png";
    if (!name.starts_with(kHead) || !name.ends_with(kTail) || name.size() <= kHead.size() + kTail.size()) return false;
    const auto digits = name.substr(kHead.size(), name.size() - kHead.size() - kTail.size());
    return std::ranges::all_of(digits, [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isLeftByARun(std::string name)
{
    if (name.ends_with(".part")) name.resize(name.size() - std::string_view(".part").size());
    return isFrame(name) || std::ranges::find(kRunFiles, name) != kRunFiles.end();
}

void requireOwner(const fs::path& folder, const FolderOwner& owner)
{
    const auto report = folder / "report.json";
    if (!fs::exists(report)) {
        if (fs::exists(folder / "steps.jsonl") || fs::is_empty(folder)) return;
        throw sim::InputError(fmt::format(
            "--out {}: the folder holds files that are no results of a run; choose another or empty it", folder.string()));
    }
    const auto json = nlohmann::json::parse(readWhole(report), nullptr, false);
    FolderOwner found;
    if (json.is_object()) found = {json.value("scene", ""), json.value("variant", "")};
    if (found != owner)
        throw sim::InputError(fmt::format("--out {}: the folder holds results of scene \"{}\", variant \"{}\"; choose another or delete it",
                                          folder.string(), found.scene, found.variant));
}

}  // namespace

void makeFolder(const fs::path& folder)
{
    if (fs::exists(folder) && !fs::is_directory(folder))
        throw sim::InputError(fmt::format("--out {}: this is a file, not a folder", folder.string()));
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw sim::InputError(fmt::format("--out {}: cannot make this folder: {}", folder.string(), error.message()));
}

void claimFolder(const fs::path& folder, const FolderOwner& owner)
{
    makeFolder(folder);
    requireOwner(folder, owner);
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && isLeftByARun(entry.path().filename().string())) old.push_back(entry.path());
    for (const auto& file : old) fs::remove(file);
    removeGeometry(folder);
}

}  // namespace app
