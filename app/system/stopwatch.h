#pragma once

#include <chrono>

namespace app {

/// What the clock on the wall shows [s].
inline double secondsSince(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace app
