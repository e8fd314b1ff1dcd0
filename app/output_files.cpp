#include "app/output_files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace app {

namespace {

[[noreturn]] void throwSystemReason(std::string_view what, const std::filesystem::path& file)
{
    throw std::runtime_error(fmt::format("cannot {} {}: {}", what, file.string(), std::strerror(errno)));
}

}  // namespace

std::filesystem::path partFile(const std::filesystem::path& target)
{
    auto part = target;
    part += ".part";
    return part;
}

void putInPlace(const std::filesystem::path& part, const std::filesystem::path& target)
{
    std::error_code error;
    std::filesystem::rename(part, target, error);
    if (error) throw std::runtime_error(fmt::format("cannot write {}: {}", target.string(), error.message()));
}

void writeWhole(const std::filesystem::path& target, std::string_view content)
{
    const auto part = partFile(target);
    try {
        errno = 0;
        std::ofstream out(part, std::ios::binary);
        out << content << std::flush;
        out.close();
        if (!out) throwSystemReason("write", part);
        putInPlace(part, target);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw;
    }
}

std::string readWhole(const std::filesystem::path& file)
{
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) throwSystemReason("read", file);
    std::ostringstream content;
    content << in.rdbuf();
    return content.str();
}

LineFile::LineFile(const std::filesystem::path& file) : file_(file)
{
    errno = 0;
    out_.open(file, std::ios::binary);
    if (!out_) throwSystemReason("write", file_);
}

void LineFile::add(std::string_view line)
{
    errno = 0;
    out_ << line << '\n' << std::flush;
    if (!out_) throwSystemReason("write", file_);
}

}  // namespace app
