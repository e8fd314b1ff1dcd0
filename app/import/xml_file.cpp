#include "app/import/xml_file.h"

#include "app/system/atomic_files.h"
#include "sim/core/check.h"
#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <algorithm>

namespace app {

namespace {

constexpr std::uintmax_t kMaxBytes = 256u << 20;  // the largest published scene has 4 MB
constexpr int kMaxDepth = 16;                     // scenes need 4

/// Offset of the first byte that is no UTF-8; the size of the text if all is.
std::size_t firstBadByte(std::string_view text)
{
    std::size_t i = 0;
    while (i < text.size()) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t more = lead < 0x80 ? 0 : (lead >> 5) == 6 ? 1 : (lead >> 4) == 14 ? 2 : (lead >> 3) == 30 ? 3 : 4;
        if (more == 4 || i + more >= text.size()) return i;
        for (std::size_t k = 1; k <= more; ++k)
            if ((static_cast<unsigned char>(text[i + k]) >> 6) != 2) return i;
        i += more + 1;
    }
    return text.size();
}

std::string readBytes(const std::filesystem::path& path)
{
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw sim::InputError(fmt::format("there is no file {}", sim::fileInQuotes(path.string())));
    if (!std::filesystem::is_regular_file(status)) throw sim::InputError(fmt::format("{} is no file", sim::fileInQuotes(path.string())));
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > kMaxBytes)
        throw sim::InputError(
            fmt::format("{}: is larger than {} MB, which no scene of libWetCloth is; is it the right file?", path.string(), kMaxBytes >> 20));
    return readWhole(path);
}

}  // namespace

XmlFile::XmlFile(const std::filesystem::path& file) : path_(file), text_(readBytes(file))
{
    if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);
    lineStarts_.push_back(0);
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n') lineStarts_.push_back(i + 1);
    requireText();
    parse();
    requirePlainTree();
}

int XmlFile::lineAt(std::ptrdiff_t offset) const
{
    return static_cast<int>(std::ranges::upper_bound(lineStarts_, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0))) -
                            lineStarts_.begin());
}

int XmlFile::line(const pugi::xml_node& node) const { return lineAt(node.offset_debug()); }

void XmlFile::fail(int line, const std::string& message) const { throw sim::InputError(fmt::format("{}:{}: {}", path_.string(), line, message)); }

void XmlFile::requireText() const
{
    const bool isUtf16 = text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff");
    if (isUtf16 || text_.find('\0') != std::string::npos)
        fail(1, isUtf16 ? "is UTF-16; save it as UTF-8" : "has zero bytes, so it is no text, or UTF-16; a scene is XML in UTF-8");
    const std::size_t bad = firstBadByte(text_);
    if (bad < text_.size()) fail(lineAt(static_cast<std::ptrdiff_t>(bad)), "has a letter that is no UTF-8; save the file as UTF-8");
    const std::size_t first = text_.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) fail(1, "is empty; a scene is XML that begins with <scene>");
    if (text_[first] != '<') fail(lineAt(static_cast<std::ptrdiff_t>(first)), "is no XML; a scene begins with <scene>");
}

void XmlFile::parse()
{
    const unsigned options = pugi::parse_default | pugi::parse_doctype;
    const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size(), options, pugi::encoding_utf8);
    if (result.status == pugi::status_out_of_memory) throw std::bad_alloc();
    if (!result) {
        // What is cut off is noticed at the end, or where its last tag begins.
        const std::size_t end = text_.find_last_not_of(" \t\r\n");
        const bool isCutOff = text_.find("</scene", static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))) == std::string::npos &&
                              !std::string_view(text_).substr(0, end + 1).ends_with("</scene>");
        if (isCutOff) fail(lineAt(static_cast<std::ptrdiff_t>(end)), "ends before </scene>; the file is cut off, copy it once more");
        fail(lineAt(result.offset), fmt::format("is no well-formed XML ({}); correct the tags here", result.description()));
    }
    for (const pugi::xml_node& node : document_.children())
        if (node.type() == pugi::node_doctype) fail(node, "has a DOCTYPE, and entities are not read; remove it, scenes need none");
    const std::string name = root().name();
    if (name != "scene") fail(root(), fmt::format("its root is {}, so it is no scene of libWetCloth, which has <scene>", sim::inQuotes(name)));
    if (const pugi::xml_node second = root().next_sibling()) fail(second, "something follows behind </scene>; one file holds one scene");
}

void XmlFile::requirePlainTree() const
{
    int depth = 0;
    for (pugi::xml_node node = root(); node;) {
        if (pugi::xml_node child = node.first_child()) {
            if (++depth > kMaxDepth)
                fail(child, fmt::format("elements stand more than {} deep in one another, scenes have 4 at most; correct the tags", kMaxDepth));
            node = child;
            continue;
        }
        while (node && node != root() && !node.next_sibling()) {
            node = node.parent();
            --depth;
        }
        node = node == root() ? pugi::xml_node() : node.next_sibling();
    }
}

}  // namespace app
