#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// Where the geometry of a run is: geometry/ below its folder.
std::filesystem::path geometryFolder(const std::filesystem::path& runFolder);

/// File beside the geometry that tells on what it was made, and from what.
inline constexpr std::string_view kGeometryProvenance = "provenance.json";

/// "liquid_00012.vtp"
std::string geometryFileName(std::string_view part, std::int64_t frame, std::string_view extension);

/// Frames of which a run has left geometry in its folder, ascending.
std::vector<std::int64_t> geometryFrames(const std::filesystem::path& runFolder);

/// Take away the geometry that a run has left of frames after this one, and with frame −1 all: files that an Exporter writes, never
/// others.
void removeGeometryAfter(std::int64_t frame, const std::filesystem::path& runFolder);

}  // namespace app
