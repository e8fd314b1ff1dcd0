#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace app::test {

/// A file that somebody drags from another program onto a window and lets go there, by the XDND protocol of X11.
class DraggedFile {
 public:
    /// @param window  its title
    DraggedFile(const std::filesystem::path& file, const std::string& window);
    ~DraggedFile();

    /// Answer what the window has asked since the last call. True once it has taken the file.
    bool isTaken();

 private:
    struct Connection;
    std::unique_ptr<Connection> connection_;
};

}  // namespace app::test
