#pragma once

#include "app/import/xml_file.h"
#include "sim/core/types.h"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace app {

/// Names that somebody asked for, like "particle@x" or "liquidinfo/viscosity": all others in a file are ignored ones.
using NamesRead = std::set<std::string, std::less<>>;

/// One element of a scene, as its readers ask for it. What is no number, or not finite, is refused with its line.
class XmlElement {
 public:
    XmlElement(const XmlFile& file, pugi::xml_node node, NamesRead& names) : file_(&file), node_(node), names_(&names) {}

    explicit operator bool() const { return !node_.empty(); }
    int line() const { return file_->line(node_); }
    [[noreturn]] void fail(const std::string& message) const;

    /// The first child of that name; empty if there is none.
    XmlElement child(const char* name) const;
    std::vector<XmlElement> children(const char* name) const;

    bool has(const char* attribute) const { return !node_.attribute(attribute).empty(); }
    std::string text(const char* attribute, const std::string& fallback = {}) const;
    double number(const char* attribute, double fallback) const;
    double number(const char* attribute) const;  ///< fails where there is none
    int integer(const char* attribute, int fallback) const;
    bool flag(const char* attribute, bool fallback) const;
    /// "x y z", any white space between.
    sim::Vec3 vector(const char* attribute, const sim::Vec3& fallback) const;
    std::vector<int> integers(const char* attribute) const;
    std::vector<double> numbers(const char* attribute) const;

    /// What stands in a child: <viscosity value="8.9e-3"/>.
    bool hasValue(const char* child) const;
    double value(const char* child, double fallback) const;
    int value(const char* child, int fallback) const;
    bool value(const char* child, bool fallback) const;
    std::string value(const char* child, const std::string& fallback) const;

 private:
    std::string_view read(const char* attribute) const;
    XmlElement valueElement(const char* name) const;
    std::string called(const char* attribute) const;
    double numberFrom(std::string_view text, const char* attribute) const;
    int integerFrom(std::string_view text, const char* attribute) const;
    std::vector<std::string_view> words(const char* attribute) const;

    const XmlFile* file_;
    pugi::xml_node node_;
    NamesRead* names_;
};

}  // namespace app
