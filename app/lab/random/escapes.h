#pragma once

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>

namespace app {

/// What of the last state that a run kept is where it cannot have come to without passing through a solid: particles or vertices inside of
/// one, or outside of the vessel that they were in. Fabric without contact feels no solid; pinned vertices go where they are led and may drip
/// there; what begins in a solid may stay there, and what begins out of the vessel out of it. Empty if there is nothing.
std::string describeEscape(const std::filesystem::path& scene, const std::filesystem::path& folder, const std::optional<Eigen::AlignedBox3d>& vessel);

}  // namespace app
