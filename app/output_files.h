#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace app {

/// The temporary name under which a file is written before it takes its own: the same with ".part" behind it.
std::filesystem::path partFile(const std::filesystem::path& target);

/// Give a finished file its name, replacing what was there; nobody ever sees half a file. Throws std::runtime_error.
void putInPlace(const std::filesystem::path& part, const std::filesystem::path& target);

/// Write a whole file, or leave the old one as it was. Throws std::runtime_error with the system's reason.
void writeWhole(const std::filesystem::path& target, std::string_view content);

/// The whole content. Throws std::runtime_error.
std::string readWhole(const std::filesystem::path& file);

/// A text file that grows line by line; every line is in the file, whole, when add() returns.
class LineFile {
 public:
    explicit LineFile(const std::filesystem::path& file);  ///< starts empty
    void add(std::string_view line);                       ///< throws std::runtime_error when the disk takes no more

 private:
    std::filesystem::path file_;
    std::ofstream out_;
};

}  // namespace app
