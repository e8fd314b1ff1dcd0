#pragma once

#include <string>
#include <vector>

namespace app {

/// What stands between the commas of a line. Our own tables have no commas, quotes or line breaks within a cell. An
/// empty last cell is not told from none.
std::vector<std::string> csvCells(const std::string& line);

}  // namespace app
