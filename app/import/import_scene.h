#pragma once

#include "app/backends.h"
#include "app/options.h"

#include <filesystem>
#include <string>

namespace app {

/// Writes a scene of libWetCloth as a scene file, what no generator makes of its fabric as OBJ files, and
/// <stem>.import.txt with what was decided, all beside `yaml`; returns that report. The scene is read back and compared
/// with the XML before anything takes its name. Throws InputError "file:line: what, and what would do", and then leaves
/// nothing behind.
std::string importScene(const std::filesystem::path& xml, const std::filesystem::path& yaml, const ImportOptions& options, const Backends& backends);

}  // namespace app
