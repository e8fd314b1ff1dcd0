#include "sim/scene/section_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace sim {

namespace {

[[noreturn]] void failAt(const Node& node, const std::string& path, const std::string& message)
{
    fail(node.location, fmt::format("{}: {}", path, message));
}

template <class Integer>
bool parseWhole(const std::string& text, Integer& out)
{
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
}

void readWholeNumbers(const Node& node, const std::string& path, const char* example, std::array<int*, 2> out, int low, int high)
{
    if (!node.isList() || node.items.size() != 2)
        failAt(node, path, fmt::format("needs a list of 2 whole numbers, like {}, not {}", example, node.called()));
    for (std::size_t i = 0; i < 2; ++i) *out[i] = static_cast<int>(readInteger(node.items[i], path, low, high));
}

}  // namespace

std::string Range::text(const std::string& unit) const
{
    const std::string suffix = unit.empty() ? "" : " " + unit;
    const bool hasLow = low > -std::numeric_limits<double>::infinity();
    const bool hasHigh = high < std::numeric_limits<double>::infinity();
    if (hasLow && hasHigh && isLowOpen && isHighOpen) return fmt::format("above {}, below {}{}", low, high, suffix);
    if (hasLow && hasHigh && isLowOpen) return fmt::format("above {}, at most {}{}", low, high, suffix);
    if (hasLow && hasHigh) return fmt::format("{} to {}{}", low, high, suffix);
    if (hasLow) return fmt::format("{} {}{}", isLowOpen ? "above" : "at least", low, suffix);
    return hasHigh ? fmt::format("at most {}{}", high, suffix) : "";
}

double readNumber(const Node& node, const std::string& path, Quantity quantity, const Range& range)
{
    const char* unit = unitOf(quantity);
    if (!node.isScalar()) failAt(node, path, fmt::format("needs {}, not {}", nameOf(quantity), node.called()));
    const ParsedNumber number = parseNumber(node.text, quantity, node.location.source && node.location.source->isSi);
    if (!number.problem.empty()) failAt(node, path, number.problem);
    const double inFile = inFileUnits(number.value, quantity);
    if (!range.contains(inFile)) failAt(node, path, fmt::format("{} is out of range; must be {}", inQuotes(node.text), range.text(unit)));
    return number.value;
}

void readNumbers(const Node& node, const std::string& path, std::span<double> out, Quantity quantity, const Range& range)
{
    if (!node.isList() || node.items.size() != out.size()) {
        failAt(node, path,
               fmt::format("needs a list of {} numbers, like {}, not {}", out.size(), out.size() == 3 ? "[0, 1, 0]" : "[0, 1]", node.called()));
    }
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = readNumber(node.items[i], path, quantity, range);
}

std::int64_t readInteger(const Node& node, const std::string& path, std::int64_t low, std::int64_t high)
{
    std::int64_t value = 0;
    if (!node.isScalar() || !parseWhole(node.text, value))
        failAt(node, path, fmt::format("needs a whole number, {} to {}, not {}", low, high, node.called()));
    if (value < low || value > high) failAt(node, path, fmt::format("{} is out of range; must be {} to {}", value, low, high));
    return value;
}

std::uint64_t readSeed(const Node& node, const std::string& path)
{
    std::uint64_t value = 0;
    if (!node.isScalar() || !parseWhole(node.text, value)) failAt(node, path, fmt::format("needs a whole number, 0 or more, not {}", node.called()));
    return value;
}

bool readFlag(const Node& node, const std::string& path)
{
    if (node.isScalar() && node.text == "true") return true;
    if (!node.isScalar() || node.text != "false") failAt(node, path, fmt::format("needs true or false, not {}", node.called()));
    return false;
}

const std::string& readText(const Node& node, const std::string& path)
{
    if (!node.isScalar()) failAt(node, path, fmt::format("needs a text, not {}", node.called()));
    return node.text;
}

std::vector<std::string> readTexts(const Node& node, const std::string& path)
{
    if (!node.isList()) failAt(node, path, fmt::format("needs a list of words, not {}", node.called()));
    std::vector<std::string> texts;
    for (const Node& item : node.items) texts.push_back(readText(item, path));
    return texts;
}

std::size_t readChoice(const Node& node, const std::string& path, const std::vector<std::string>& words)
{
    if (!node.isScalar()) failAt(node, path, fmt::format("needs one word of {}, not {}", listed(words), node.called()));
    const auto found = std::ranges::find(words, node.text);
    if (found == words.end()) failAt(node, path, fmt::format("{} is unknown{}", inQuotes(node.text), suggestion(node.text, words)));
    return static_cast<std::size_t>(found - words.begin());
}

void readNamedFlags(const Node& node, const std::string& path, std::span<const NamedFlag> flags)
{
    if (!node.isList()) failAt(node, path, fmt::format("needs a list of words, not {}", node.called()));
    std::vector<std::string> words;
    for (const NamedFlag& f : flags) {
        words.emplace_back(f.word);
        *f.value = false;
    }
    for (const Node& item : node.items) {
        const std::string& text = readText(item, path);
        const auto found = std::ranges::find(words, text);
        if (found == words.end()) failAt(item, path, fmt::format("{} is unknown{}", inQuotes(text), suggestion(text, words)));
        *flags[static_cast<std::size_t>(found - words.begin())].value = true;
    }
}

SectionReader::SectionReader(const Node& node, std::string path) : node_(node), path_(std::move(path))
{
    if (!node_.isMap()) failAt(node_, path_, fmt::format("needs a map of keys, not {}", node_.called()));
}

SourceLocation SectionReader::locationOf(const char* key) const
{
    if (const Node* n = find(key)) return n->location;
    return node_.location;
}

void SectionReader::numberOrWord(const char* key, const NumberOrWord& out, Quantity quantity, Range range, const char*)
{
    const Node* n = find(key);
    if (!n) return;
    out.isWord = n->isScalar() && n->text == out.word;
    if (!out.isWord) out.number = readNumber(*n, pathOf(key), quantity, range);
}

void SectionReader::numberOrPair(const char* key, std::array<double, 2>& out, Quantity quantity, Range range, const char*)
{
    const Node* n = find(key);
    if (!n) return;
    if (n->isList()) return readNumbers(*n, pathOf(key), out, quantity, range);
    out.fill(readNumber(*n, pathOf(key), quantity, range));
}

void SectionReader::pixels(const char* key, int& width, int& height, int low, int high, const char*)
{
    const Node* n = find(key);
    if (!n) return;
    readWholeNumbers(*n, pathOf(key), "[960, 540]", {&width, &height}, low, high);
}

void SectionReader::counts(const char* key, Eigen::Vector2i& out, int low, int high, const char*)
{
    const Node* n = find(key);
    if (!n) return;
    readWholeNumbers(*n, pathOf(key), "[20, 30]", {&out[0], &out[1]}, low, high);
}

void SectionReader::color(const char* key, Eigen::Vector3f& out, const char*)
{
    const Node* n = find(key);
    if (!n) return;
    Vec3 rgb;
    readNumbers(*n, pathOf(key), {rgb.data(), 3}, Quantity::None, Range::between(0.0, 1.0));
    out = rgb.cast<float>();
}

void SectionReader::onlySupports(const char* key, const char* word, std::initializer_list<const char*> others, const char*)
{
    const Node* n = find(key);
    if (!n || (n->isScalar() && n->text == word)) return;
    if (n->isScalar() && std::ranges::find(others, n->text) != others.end())
        failAt(*n, pathOf(key), fmt::format("{} does not run in this version; write {}", n->text, word));
    readChoice(*n, pathOf(key), {word});
}

void SectionReader::unsupported(const char* key, const char* message)
{
    if (const Node* n = find(key)) failAt(*n, pathOf(key), message);
}

void SectionReader::required(const char* key, const char* what)
{
    if (!has(key)) fail(locationOf(key), fmt::format("{} is missing; it is {}", pathOf(key), what));
}

void SectionReader::require(bool isMet, const char* key, const std::string& message)
{
    if (!isMet) fail(locationOf(key), fmt::format("{}: {}", pathOf(key), message));
}

void SectionReader::refuseKeysBut(const std::vector<std::string>& known, const std::vector<std::string>& later) const
{
    const auto isIn = [](const std::vector<std::string>& list, const std::string& key) {
        return std::find(list.begin(), list.end(), key) != list.end();
    };
    for (std::size_t i = 0; i < node_.keys.size(); ++i) {
        const std::string& key = node_.keys[i];
        if (isIn(known, key) || isIn(later, key)) continue;
        const std::string where = path_.empty() ? "" : " in " + path_;
        const bool isDotted = key.find('.') != std::string::npos;
        fail(node_.items[i].location,
             fmt::format("unknown key {}{}{}", inQuotes(key), where,
                         isDotted ? "; dotted keys stand in variants and behind --set, write them as maps here" : suggestion(key, known)));
    }
}

}  // namespace sim
