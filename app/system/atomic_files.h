#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// The temporary name under which a file is written before it takes its own: the same with ".part" behind it.
std::filesystem::path partFile(const std::filesystem::path& target);

/// Give a finished file its name, replacing what was there; nobody ever sees half a file. Throws std::runtime_error.
void putInPlace(const std::filesystem::path& part, const std::filesystem::path& target);

/// Write a whole file, or leave the old one as it was. Throws std::runtime_error with the system's reason.
void writeWhole(const std::filesystem::path& target, std::string_view content);
void writeWhole(const std::filesystem::path& target, std::initializer_list<std::string_view> parts);

/// The whole content. Throws std::runtime_error.
std::string readWhole(const std::filesystem::path& file);

/// The number in a file's name like "frame_00012.png", between these; −1 for other names.
std::int64_t numberIn(std::string_view name, std::string_view before, std::string_view after);

/// Numbers of all such files in a folder, ascending; none where there is no folder.
std::vector<std::int64_t> numbersIn(const std::filesystem::path& folder, std::string_view before, std::string_view after);

/// A text file that grows line by line; every line is in the file, whole, when add() returns.
class LineFile {
 public:
    explicit LineFile(const std::filesystem::path& file);  ///< starts empty
    /// Goes on behind the first `bytes` of what is there. Throws InputError if there is less.
    LineFile(const std::filesystem::path& file, std::uintmax_t bytes);
    void add(std::string_view line);               ///< throws std::runtime_error when the disk takes no more
    std::uintmax_t size() const { return size_; }  ///< [bytes]

 private:
    std::filesystem::path file_;
    std::ofstream out_;
    std::uintmax_t size_ = 0;
};

}  // namespace app
