#include "sim/scene/read_list.h"

#include "sim/scene/section_reader.h"

#include <algorithm>

namespace sim {

const Node* listAt(const Node* map, const char* key, const std::string& path, const char* example)
{
    const Node* node = map ? map->find(key) : nullptr;
    if (node && !node->isList()) fail(node->location, fmt::format("{}: needs a list like {}, not {}", path, example, node->called()));
    return node;
}

std::string nameIn(const Node& element, std::size_t index, const std::string& path)
{
    const Node* name = element.find("name");
    if (!name) return std::to_string(index);
    const std::string& text = readText(*name, joinPath(path, std::to_string(index) + ".name"));
    requireName(text, name->location, fmt::format("{}.{}.name", path, index));
    return text;
}

void requireName(const std::string& text, const SourceLocation& location, const std::string& path)
{
    const auto isAllowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
    if (text.empty() || !std::all_of(text.begin(), text.end(), isAllowed))
        fail(location, fmt::format("{}: {} may have letters, digits, _ and - only", path, inQuotes(text)));
}

}  // namespace sim
