#include "app/import/scene_lines.h"

#include <algorithm>

namespace app {

namespace {

constexpr std::size_t kWidth = 150;

/// Where a list or map in flow style may go on in the next line: behind the last of its outermost commas that fits;
/// nowhere if a comma may stand in quotes.
std::size_t breakOf(const std::string& text, int depth)
{
    std::size_t best = std::string::npos;
    int lowest = 0;
    if (text.find_first_of("\"#") != std::string::npos) return best;
    for (std::size_t i = 0; i < kWidth && i < text.size(); ++i) {
        if (text[i] == '[' || text[i] == '{') ++depth;
        if (text[i] == ']' || text[i] == '}') --depth;
        if (text[i] != ',' || depth == 0 || (best != std::string::npos && depth > lowest)) continue;
        lowest = depth;
        best = i + 1;
    }
    return best;
}

/// Brackets that are open at the end of the text.
int openBrackets(const std::string& text)
{
    const auto count = [&](char a, char b) { return std::ranges::count(text, a) + std::ranges::count(text, b); };
    return static_cast<int>(count('[', '{') - count(']', '}'));
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
    for (int open = 0; rest.size() > kWidth;) {
        const std::size_t end = breakOf(rest, open);
        if (end == std::string::npos) break;
        put(lead + rest.substr(0, end));
        open += openBrackets(rest.substr(0, end));
        rest.erase(0, end + 1);
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

int SceneLines::xmlLine(int line) const { return line >= 1 && line <= static_cast<int>(xmlLines_.size()) ? xmlLines_[line - 1] : 1; }

}  // namespace app
