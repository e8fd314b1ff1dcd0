#include "app/live/recent_files.h"

#include "app/system/atomic_files.h"

#include <cstdlib>
#include <fstream>

namespace app {

namespace fs = std::filesystem;

namespace {

fs::path stateFolder()
{
    const char *state = std::getenv("XDG_STATE_HOME"), *home = std::getenv("HOME");
    if (state && *state) return state;
    return home && *home ? fs::path(home) / ".local/state" : fs::path();
}

}  // namespace

RecentFiles::RecentFiles()
{
    if (stateFolder().empty()) return;
    list_ = stateFolder() / "drench/recent";
    std::ifstream in(list_);
    for (std::string line; files_.size() < kMost && std::getline(in, line);)
        if (!line.empty()) files_.push_back(line);
}

void RecentFiles::add(const fs::path& file)
{
    std::error_code error;
    const fs::path absolute = fs::absolute(file, error);
    const std::string name = (error ? file : absolute.lexically_normal()).string();
    std::erase(files_, name);
    files_.insert(files_.begin(), name);
    if (files_.size() > kMost) files_.resize(kMost);
    if (list_.empty()) return;
    std::string all;
    for (const std::string& one : files_) all += one + '\n';
    fs::create_directories(list_.parent_path(), error);
    try {
        writeWhole(list_, all);
    } catch (const std::runtime_error&) {
    }
}

}  // namespace app
