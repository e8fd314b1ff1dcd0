#include "app/reports/output_folder.h"

#include "app/system/atomic_files.h"
#include "sim/core/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace app {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 9> kRunFiles = {"report.json", "steps.jsonl", "energy.csv", "energy_ledger.csv", "probes.csv",
                                                       "probes.png",  "probes.gp",   "video.mp4",  "resolved.yaml"};

/// Files with numbers that a run leaves in its folder, and in folders below.
struct NumberedFiles {
    std::string_view folder, before, after;
};
constexpr std::array<NumberedFiles, 3> kNumberedFiles = {{{"", "frame_", ".png"}, {"checkpoints", "state_", ".h5"}, {"states", "state_", ".h5"}}};

std::string withoutPart(std::string name)
{
    if (name.ends_with(".part")) name.resize(name.size() - std::string_view(".part").size());
    return name;
}

bool isRunFile(const std::string& name) { return std::ranges::find(kRunFiles, name) != kRunFiles.end(); }

/// Remove files that satisfy isOld(name), whole or not, of all that are in a folder.
template <class F>
void removeFrom(const fs::path& folder, F&& isOld)
{
    std::vector<fs::path> old;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none))
        if (entry.is_regular_file() && isOld(withoutPart(entry.path().filename().string()))) old.push_back(entry.path());
    for (const auto& file : old) fs::remove(file);
}

void requireOwner(const fs::path& folder, const FolderOwner& owner)
{
    const auto report = folder / "report.json";
    if (!fs::exists(report)) {
        if (fs::exists(folder / "steps.jsonl") || fs::is_empty(folder)) return;
        throw sim::InputError(
            fmt::format("--out {}: the folder holds files that are no results of a run; choose another or empty it", folder.string()));
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
    removeFrom(folder, isRunFile);
    removeFramesAfter(-1, folder);
    std::error_code isNotEmpty;
    for (const NumberedFiles& files : kNumberedFiles)
        if (!files.folder.empty()) fs::remove(folder / files.folder, isNotEmpty);
}

void removeFramesAfter(std::int64_t frame, const fs::path& folder)
{
    for (const NumberedFiles& files : kNumberedFiles)
        removeFrom(folder / files.folder, [&](const std::string& name) { return numberIn(name, files.before, files.after) > frame; });
}

}  // namespace app
