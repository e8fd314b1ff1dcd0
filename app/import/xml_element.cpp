#include "app/import/xml_element.h"

#include "sim/scene/source_location.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace app {

void XmlElement::fail(const std::string& message) const { file_->fail(node_, message); }

XmlElement XmlElement::child(const char* name) const
{
    names_->insert(fmt::format("{}/{}", node_.name(), name));
    return {*file_, node_.child(name), *names_};
}

std::vector<XmlElement> XmlElement::children(const char* name) const
{
    names_->insert(fmt::format("{}/{}", node_.name(), name));
    std::vector<XmlElement> all;
    for (const pugi::xml_node& node : node_.children(name)) all.emplace_back(*file_, node, *names_);
    return all;
}

std::string_view XmlElement::read(const char* attribute) const
{
    std::string key = called(attribute);
    if (names_->find(key) == names_->end()) names_->insert(std::move(key));
    return node_.attribute(attribute).value();
}

/// "particle@x", for messages and names.
std::string XmlElement::called(const char* attribute) const { return fmt::format("{}@{}", node_.name(), attribute); }

std::string XmlElement::text(const char* attribute, const std::string& fallback) const
{
    const std::string_view given = read(attribute);
    return has(attribute) ? std::string(given) : fallback;
}

double XmlElement::numberFrom(std::string_view text, const char* attribute) const
{
    std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
    while (!digits.empty() && (digits.front() == ' ' || digits.front() == '\t' || digits.front() == '\n')) digits.remove_prefix(1);
    while (!digits.empty() && (digits.back() == ' ' || digits.back() == '\t' || digits.back() == '\n')) digits.remove_suffix(1);
    double number = 0.0;
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (problem != std::errc() || end != digits.data() + digits.size() || !std::isfinite(number))
        fail(fmt::format("{}: {} is no number that can be computed with; write one like 0.5 or 1.2e-3", called(attribute), sim::inQuotes(text)));
    return number;
}

int XmlElement::integerFrom(std::string_view text, const char* attribute) const
{
    constexpr double kLargest = 1.0e9;
    const double number = numberFrom(text, attribute);
    if (number != std::floor(number) || std::abs(number) > kLargest)
        fail(fmt::format("{}: {} is no whole number up to {:.0e}; write one like 3", called(attribute), sim::inQuotes(text), kLargest));
    return static_cast<int>(number);
}

double XmlElement::number(const char* attribute, double fallback) const
{
    const std::string_view given = read(attribute);
    return has(attribute) ? numberFrom(given, attribute) : fallback;
}

double XmlElement::number(const char* attribute) const
{
    const std::string_view given = read(attribute);
    if (!has(attribute)) fail(fmt::format("{} is missing; it is a number like {}=\"0.5\"", called(attribute), attribute));
    return numberFrom(given, attribute);
}

int XmlElement::integer(const char* attribute, int fallback) const
{
    const std::string_view given = read(attribute);
    return has(attribute) ? integerFrom(given, attribute) : fallback;
}

bool XmlElement::flag(const char* attribute, bool fallback) const
{
    const std::string_view given = read(attribute);
    if (!has(attribute)) return fallback;
    if (given == "1" || given == "true") return true;
    if (given == "0" || given == "false") return false;
    fail(fmt::format("{}: {} is neither 0 nor 1; write one of them", called(attribute), sim::inQuotes(given)));
}

std::vector<std::string_view> XmlElement::words(const char* attribute) const
{
    constexpr const char* kSpace = " \t\r\n,";
    const std::string_view given = read(attribute);
    std::vector<std::string_view> all;
    for (std::size_t begin = given.find_first_not_of(kSpace); begin < given.size(); begin = given.find_first_not_of(kSpace, begin)) {
        const std::size_t end = std::min(given.find_first_of(kSpace, begin), given.size());
        all.push_back(given.substr(begin, end - begin));
        begin = end;
    }
    return all;
}

sim::Vec3 XmlElement::vector(const char* attribute, const sim::Vec3& fallback) const
{
    const std::vector<std::string_view> given = words(attribute);
    if (!has(attribute)) return fallback;
    if (given.size() != 3)
        fail(fmt::format("{}: needs three numbers like \"0 1 0\", not {}", called(attribute), sim::inQuotes(node_.attribute(attribute).value())));
    return {numberFrom(given[0], attribute), numberFrom(given[1], attribute), numberFrom(given[2], attribute)};
}

std::vector<int> XmlElement::integers(const char* attribute) const
{
    std::vector<int> all;
    for (const std::string_view word : words(attribute)) all.push_back(integerFrom(word, attribute));
    return all;
}

std::vector<double> XmlElement::numbers(const char* attribute) const
{
    std::vector<double> all;
    for (const std::string_view word : words(attribute)) all.push_back(numberFrom(word, attribute));
    return all;
}

XmlElement XmlElement::valueElement(const char* name) const
{
    const XmlElement element = child(name);
    if (element && !element.has("value")) element.fail(fmt::format("{}@value is missing; write <{} value=\"…\"/>", name, name));
    return element;
}

bool XmlElement::hasValue(const char* child) const { return !node_.child(child).empty(); }

double XmlElement::value(const char* child, double fallback) const
{
    const XmlElement element = valueElement(child);
    return element ? element.number("value", fallback) : fallback;
}

int XmlElement::value(const char* child, int fallback) const
{
    const XmlElement element = valueElement(child);
    return element ? element.integer("value", fallback) : fallback;
}

bool XmlElement::value(const char* child, bool fallback) const
{
    const XmlElement element = valueElement(child);
    return element ? element.flag("value", fallback) : fallback;
}

std::string XmlElement::value(const char* child, const std::string& fallback) const
{
    const XmlElement element = valueElement(child);
    return element ? element.text("value", fallback) : fallback;
}

}  // namespace app
