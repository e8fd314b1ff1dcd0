#pragma once

#include <filesystem>
#include <string>

namespace app {

/// Where Drench keeps its own files, say dataFolder("shaders"): beside the installed program (../share/drench), else in
/// the source tree it was built from.
std::filesystem::path dataFolder(const std::string& name);

}  // namespace app
