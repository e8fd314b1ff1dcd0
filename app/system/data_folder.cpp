#include "app/system/data_folder.h"

namespace app {

std::filesystem::path dataFolder(const std::string& name)
{
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
    const auto installed = program.parent_path().parent_path() / "share" / "drench" / name;
    return std::filesystem::exists(installed) ? installed : std::filesystem::path(DRENCH_SOURCE_DIR) / name;
}

}  // namespace app
