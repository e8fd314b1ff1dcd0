#pragma once

#include <string>

namespace app {

/// Text inside a cell of a Markdown table.
inline std::string markdownCell(std::string text)
{
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
    return text;
}

}  // namespace app
