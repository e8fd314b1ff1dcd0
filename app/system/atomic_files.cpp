#include "app/system/atomic_files.h"

#include "sim/core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iterator>
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

void writeWhole(const std::filesystem::path& target, std::string_view content) { writeWhole(target, {content}); }

void writeWhole(const std::filesystem::path& target, std::initializer_list<std::string_view> parts)
{
    const auto part = partFile(target);
    try {
        errno = 0;
        std::ofstream out(part, std::ios::binary);
        for (const std::string_view content : parts) out << content;
        out << std::flush;
        out.close();
        if (!out) throwSystemReason("write", part);
        putInPlace(part, target);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);  // a full disk gets its room back
        throw;
    }
}

std::string readWhole(const std::filesystem::path& file)
{
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) throwSystemReason("read", file);
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    std::string content(unknown ? 0 : size, '\0');
    in.read(content.data(), static_cast<std::streamsize>(content.size()));
    content.resize(static_cast<std::size_t>(in.gcount()));
    return content.append(std::istreambuf_iterator<char>(in), {});  // of pipes and the like, whose size is not known
}

std::int64_t numberIn(std::string_view name, std::string_view before, std::string_view after)
{
    if (!name.starts_with(before) || !name.ends_with(after) || name.size() <= before.size() + after.size()) return -1;
    const std::string_view digits = name.substr(before.size(), name.size() - before.size() - after.size());
    if (!std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; })) return -1;
    std::int64_t number = -1;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc() ? number : -1;
}

std::vector<std::int64_t> numbersIn(const std::filesystem::path& folder, std::string_view before, std::string_view after)
{
    std::vector<std::int64_t> numbers;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none))
        if (const std::int64_t n = numberIn(entry.path().filename().string(), before, after); n >= 0) numbers.push_back(n);
    std::ranges::sort(numbers);
    return numbers;
}

LineFile::LineFile(const std::filesystem::path& file) : file_(file)
{
    errno = 0;
    out_.open(file, std::ios::binary);
    if (!out_) throwSystemReason("write", file_);
}

LineFile::LineFile(const std::filesystem::path& file, std::uintmax_t bytes) : file_(file), size_(bytes)
{
    std::error_code error;
    const std::uintmax_t there = std::filesystem::file_size(file, error);
    if (error || there < bytes)
        throw sim::InputError(fmt::format("{}: {} of the {} bytes are there that a run could go on behind; go on elsewhere with --out", file.string(),
                                          error ? 0 : there, bytes));
    std::filesystem::resize_file(file, bytes);
    errno = 0;
    out_.open(file, std::ios::binary | std::ios::app);
    if (!out_) throwSystemReason("write", file_);
}

void LineFile::add(std::string_view line)
{
    errno = 0;
    out_ << line << '\n' << std::flush;
    if (!out_) throwSystemReason("write", file_);
    size_ += line.size() + 1;
}

}  // namespace app
