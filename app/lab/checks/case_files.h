#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// The scenes of a folder in scenes/, here or where Drench keeps its own: all, by name, or those asked for. Throws
/// InputError naming those there are.
std::vector<std::filesystem::path> caseFiles(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace app
