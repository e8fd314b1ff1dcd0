#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace app {

/// Whose results a folder holds: report.json says so from the first moment of a run.
struct FolderOwner {
    std::string scene, variant;
    bool operator==(const FolderOwner&) const = default;
};

/// Make `folder` ready for a run: create it, or empty it of an earlier run of the same scene and variant (only of files
/// that a run leaves, never of others). Throws InputError if it is a file, holds another scene's results, or holds
/// files but no results.
void claimFolder(const std::filesystem::path& folder, const FolderOwner& owner);

/// Remove pictures and states that a run has left of frames after this one. Geometry has a function of its own, in app/export/geometry_files.h.
void removeFramesAfter(std::int64_t frame, const std::filesystem::path& folder);

/// Make the folder that holds the variants of a comparison; others' subfolders in it do not matter. Throws InputError if
/// it is a file.
void makeFolder(const std::filesystem::path& folder);

}  // namespace app
