#include "app/import/scene_lines.h"

namespace app {

namespace {

constexpr std::size_t kWidth = 150;

/// May the text go on in the next line? A list or map in flow style may, if no comma of it stands in quotes.
bool isBreakable(const std::string& text)
{
    const std::size_t bracket = text.find_first_of("[{");
    return bracket < kWidth && text.find_first_of("\"#") == std::string::npos;
}

}  // namespace

void SceneLines::put(std::string line)
{
    lines_.push_back(std::move(line));
    xmlLines_.push_back(xmlLine_);
}

void SceneLines::add(int depth, const std::string& text)
{
    const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
    std::string lead = indent, rest = text;
    while (rest.size() > kWidth && isBreakable(text)) {
        const std::size_t comma = rest.rfind(", ", kWidth);
        if (comma == std::string::npos || (lead == indent && comma < rest.find_first_of("[{"))) break;
        put(lead + rest.substr(0, comma + 1));
        rest.erase(0, comma + 2);
        lead = indent + "    ";
    }
    put(lead + rest);
}

std::string SceneLines::text() const
{
    std::string all;
    for (const std::string& line : lines_) all += line + '\n';
    return all;
}

int SceneLines::xmlLine(int line) const
{
    return line >= 1 && line <= static_cast<int>(xmlLines_.size()) ? xmlLines_[line - 1] : 1;
}

}  // namespace app
