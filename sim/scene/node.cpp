#include "sim/scene/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sim {

Node Node::scalar(std::string text, const SourceLocation& location)
{
    Node n;
    n.kind = Kind::Scalar;
    n.location = location;
    n.text = std::move(text);
    return n;
}

Node Node::map(const SourceLocation& location)
{
    Node n;
    n.kind = Kind::Map;
    n.location = location;
    return n;
}

const Node* Node::find(std::string_view key) const
{
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node& Node::at(const std::string& key, const SourceLocation& keyLocation)
{
    if (Node* there = find(key)) return *there;
    keys.push_back(key);
    items.emplace_back().location = keyLocation;
    return items.back();
}

void Node::erase(std::string_view key)
{
    const auto found = std::find(keys.begin(), keys.end(), key);
    if (found == keys.end()) return;
    items.erase(items.begin() + (found - keys.begin()));
    keys.erase(found);
}

namespace {

bool isPlainWord(const std::string& text)
{
    if (text.empty() || text == "~" || text == "null") return false;
    const auto isSafe = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '/' || c == '+';
    };
    const bool startsNegative = text.size() > 1 && text[0] == '-' && text[1] >= '0' && text[1] <= '9';
    if (!isSafe(text[0]) && !startsNegative) return false;
    return std::all_of(text.begin() + 1, text.end(), [&](char c) { return isSafe(c) || c == '-' || c == '^'; });
}

std::string flowText(const std::string& text)
{
    if (isPlainWord(text)) return text;
    std::string out = "\"";
    for (const char c : text) {
        switch (c) {
            case '"': out += "\\\""; break;
            case '\\': out += "\\\\"; break;
            case '\n': out += "\\n"; break;
            case '\t': out += "\\t"; break;
            case '\r': out += "\\r"; break;
            default:
                const auto byte = static_cast<unsigned char>(c);
                out += byte < 0x20 || byte == 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
        }
    }
    return out + "\"";
}

}  // namespace

std::string Node::flow() const
{
    if (isNull()) return "~";
    if (isScalar()) return flowText(text);
    std::string out = isMap() ? "{" : "[";
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i > 0) out += ", ";
        if (isMap()) out += flowText(keys[i]) + ": ";
        out += items[i].flow();
    }
    return out + (isMap() ? "}" : "]");
}

std::string Node::called() const
{
    switch (kind) {
        case Kind::Null: return "nothing";
        case Kind::Scalar: return inQuotes(text);
        case Kind::List: return items.empty() ? "an empty list" : fmt::format("a list of {}", items.size());
        default: return "a map";
    }
}

}  // namespace sim
