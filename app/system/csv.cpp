#include "app/system/csv.h"

#include <sstream>

namespace app {

std::vector<std::string> csvCells(const std::string& line)
{
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
}

}  // namespace app
