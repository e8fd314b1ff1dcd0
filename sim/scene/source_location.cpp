#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace sim {

namespace {

/// Number of letters to insert, delete, replace or swap with their neighbour to turn a into b.
std::size_t editDistance(std::string_view a, std::string_view b)
{
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    }
    return d[a.size()][b.size()];
}

std::string lowered(std::string_view text)
{
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

std::string withoutControls(std::string text)
{
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) c = '?';
    }
    return text;
}

}  // namespace

std::string SourceLocation::text() const
{
    if (!source) return "scene";
    return source->numbered ? fmt::format("{}:{}", source->name, line) : source->name;
}

void fail(const std::string& where, const std::string& message) { throw InputError(withoutControls(where + ": " + message)); }

void requireAllowed(const std::filesystem::path& file, const SourceLocation& location)
{
    if (!location.source || location.source->bounds.folder.empty()) return;
    std::error_code error;
    const auto folder = std::filesystem::weakly_canonical(location.source->bounds.folder, error);
    const auto whole = std::filesystem::weakly_canonical(file, error);
    if (error || std::ranges::mismatch(folder, whole).in1 != folder.end())
        fail(location, fmt::format("{} does not lie below the scene's folder", fileInQuotes(file.string())));
}

void fail(const SourceLocation& location, const std::string& message) { fail(location.text(), message); }

std::string fileInQuotes(const std::string& path)
{
    constexpr std::size_t kLongestPath = 4096;
    return inQuotes(path, kLongestPath);
}

std::string inQuotes(std::string_view text, std::size_t shown)
{
    if (text.size() <= shown) return withoutControls(fmt::format("\"{}\"", text));
    std::size_t end = shown;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a character
    return withoutControls(fmt::format("\"{}…\"", text.substr(0, end)));
}

std::string joinPath(const std::string& path, const std::string& key) { return path.empty() ? key : fmt::format("{}.{}", path, key); }

std::string listed(const std::vector<std::string>& names, std::size_t limit)
{
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i == limit) return out + ", …";
        out += (i > 0 ? ", " : "") + names[i];
    }
    return out;
}

std::string suggestion(std::string_view text, const std::vector<std::string>& known)
{
    constexpr std::size_t kLongestKey = 64;
    std::size_t best = std::max<std::size_t>(1, text.size() / 3) + 1;
    const std::string* nearest = nullptr;
    const std::string meant = lowered(text);
    for (const std::string& candidate : known) {
        if (text.size() > kLongestKey) break;
        const auto [shorter, longer] = std::minmax({text.size(), candidate.size()});
        if (longer - shorter >= best) continue;  // so many letters at least are missing or too many
        const std::size_t d = editDistance(meant, lowered(candidate));
        if (d < best) {
            best = d;
            nearest = &candidate;
        }
    }
    if (nearest) return fmt::format(" (did you mean \"{}\"?)", *nearest);
    return known.empty() ? "" : fmt::format(" (there is {})", listed(known));
}

}  // namespace sim
