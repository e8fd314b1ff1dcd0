#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// The scenes that were looked at last, newest first, kept in a file of the user's: $XDG_STATE_HOME/drench/recent, or
/// ~/.local/state/drench/recent.
class RecentFiles {
 public:
    static constexpr std::size_t kMost = 10;

    /// Empty where there is no such file.
    RecentFiles();

    const std::vector<std::string>& files() const { return files_; }
    /// Put it first. A disk that takes nothing is not worth a complaint: the list is then forgotten.
    void add(const std::filesystem::path& file);

 private:
    std::filesystem::path list_;
    std::vector<std::string> files_;
};

}  // namespace app
