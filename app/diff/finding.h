#pragma once

#include <string>

namespace app {

/// One thing that was compared, say a column of numbers.
struct DiffFinding {
    std::string what;      ///< "energy.csv: total_erg"
    std::string words;     ///< how far apart both are and where; empty: not at all
    bool differs = false;  ///< whether it differs by more than the tolerance
};

}  // namespace app
