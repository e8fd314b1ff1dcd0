#pragma once

#include <filesystem>

namespace app {

/// What the command line says to drench diff, beside --set and --out.
struct DiffOptions {
    std::filesystem::path a, b;          ///< what is expected, and what is held against it
    std::filesystem::path tolerances;    ///< a scene, or a file with its compare.tolerance alone; empty: that of A
    bool subset = false;                 ///< pictures that only B has do not count
};

}  // namespace app
