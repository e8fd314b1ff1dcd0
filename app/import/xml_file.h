#pragma once

#include <pugixml.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// A file of XML in memory, checked to be no more than a scene needs: UTF-8, well formed, one root <scene>, a few
/// elements deep, without entities of its own.
class XmlFile {
 public:
    /// Throws InputError, one line "file:line: what, and what would do".
    explicit XmlFile(const std::filesystem::path& file);

    const std::filesystem::path& path() const { return path_; }
    pugi::xml_node root() const { return document_.document_element(); }
    int line(const pugi::xml_node& node) const;  ///< counted from 1
    [[noreturn]] void fail(int line, const std::string& message) const;
    [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) const { fail(line(node), message); }

 private:
    int lineAt(std::ptrdiff_t offset) const;
    void requireText() const;
    void parse();
    void requirePlainTree() const;

    std::filesystem::path path_;
    std::string text_;
    std::vector<std::size_t> lineStarts_;  ///< offsets of the first letter of every line
    pugi::xml_document document_;
};

}  // namespace app
